#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <random>

#include "tests/apps/program.h"

namespace vibrissa::apps {
namespace {

/// Three columns; the stamps of a device whose clock jitters by a tenth of the sampling interval.
std::string jittering_csv(const Folder& folder, const std::string& name, const int n_rows) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::ofstream out(folder.file(name));
  out << "time_s,base_acceleration_m_s2,base_moment_N_m\n";
  out.setf(std::ios::fixed);
  out.precision(5);
  for (int i = 0; i < n_rows; ++i)
    out << 1e-3 * (i + 0.1 * normal(random)) << ',' << normal(random) << ',' << 1e-10 * i << '\n';
  return folder.file(name);
}

/// The most memory that a conversion to .npy needs at a time.
double peak_bytes(const Folder& folder, const std::string& file) {
  const std::string to = folder.file("out.npy");
  const ::pid_t process = ::fork();
  if (process == 0) {
    ::execl(VIBRISSA_PROGRAM, "vibrissa", "convert", "-q", file.c_str(), to.c_str(), nullptr);
    ::_exit(127);
  }
  int status = -1;
  ::rusage usage{};
  EXPECT_EQ(::wait4(process, &status, 0, &usage), process);
  EXPECT_EQ(status, 0);
  return 1024. * static_cast<double>(usage.ru_maxrss);
}

TEST(Memory, OfALongRecordIsThreeTimesItsNumbersAtMost) {
  constexpr int n_rows = 500'000, n_columns = 3;
  const Folder folder;
  const double at_start = peak_bytes(folder, jittering_csv(folder, "short.csv", 200));
  const double numbers = 1. * n_rows * n_columns * sizeof(double);
  EXPECT_LT(peak_bytes(folder, jittering_csv(folder, "long.csv", n_rows)) - at_start, 3. * numbers);
}

}  // namespace
}  // namespace vibrissa::apps
