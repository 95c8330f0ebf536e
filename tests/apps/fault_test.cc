#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tests/apps/program.h"

namespace vibrissa::apps {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::HasSubstr;

/// 4000 samples at 500 Hz: 64 kB of numbers.
std::string record_in(const Folder& folder) {
  std::ostringstream text;
  text << "time_s,base_acceleration_m_s2,base_moment_N_m\n";
  for (int i = 0; i < 4000; ++i)
    text << 0.002 * i << "," << std::sin(0.37 * i) + std::sin(1.9 * i) << ","
         << -6e-5 * std::sin(0.37 * i + 0.1) << "\n";
  return folder.write("record.csv", text.str());
}

// Limit in blocks of 512 bytes; larger files fail as on a full disk.
const std::string small_disk = "ulimit -f 16;";

TEST(Faults, OnAFullDiskLeaveTheOldFileAndNothingHalfWritten) {
  const Folder input;
  const std::string record = record_in(input);
  for (const std::string extension : {"csv", "mat", "h5", "npy", "uff"}) {
    const Folder folder, scratch;
    const std::string old = folder.write("out." + extension, "old");
    const auto result = vibrissa("convert '" + record + "' '" + old + "'",
                                 "TMPDIR='" + scratch.file("") + "';" + small_disk);
    EXPECT_EQ(result.status, 74) << extension;
    EXPECT_THAT(result.errors, AnyOf(HasSubstr("File too large"), HasSubstr("free disk space")))
        << extension;
    EXPECT_EQ(content(old), "old") << extension;
    EXPECT_EQ(folder.n_entries(), 1U) << extension;
    EXPECT_EQ(scratch.n_entries(), 0U) << extension;
  }
}

TEST(Faults, OutputThatDoesNotArriveIsAFailure) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const Folder folder;
  const std::string command =
      std::string("'") + VIBRISSA_PROGRAM + "' manual > /dev/full 2> '" + folder.file("err") + "'";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 74);
  EXPECT_THAT(content(folder.file("err")), HasSubstr("standard output cannot be written"));
}

TEST(Faults, TooLittleMemoryIsSaidAsSuch) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers reserve more memory than any limit allows";
#endif
  const Folder folder;
  // 800 MB of zeros that take no room on the disk; the program alone takes half a gigabyte.
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (50000000, 2), }";
  header.resize(117, ' ');
  header += '\n';
  const std::string file =
      folder.write("big.npy", std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header);
  fs::resize_file(file, 10 + header.size() + 2 * 50'000'000 * sizeof(double));
  const auto result = vibrissa("convert '" + file + "' '" + folder.file("out.csv") +
                                   "' --rate 500 --column base_acceleration=column_1",
                               "ulimit -v 1000000;");
  EXPECT_EQ(result.status, 74);
  EXPECT_THAT(result.errors, HasSubstr("not enough memory"));
  EXPECT_EQ(folder.n_entries(), 1U);
}

TEST(Faults, OfTwoRunsIntoOneFolderOneIsRefusedAndTheOtherWhole) {
  const Folder folder;
  const std::string out = folder.file("out"), run = std::string("'") + VIBRISSA_PROGRAM +
                                                    "' diagnose --example paper-gap -q -o '" + out +
                                                    "' > /dev/null 2>> '" + folder.file("err") +
                                                    "'; echo $? >> '" + folder.file("status") + "'";
  ASSERT_EQ(std::system(("(" + run + ") & (" + run + ") & wait").c_str()), 0);
  EXPECT_THAT(content(folder.file("status")), AnyOf("0\n2\n", "2\n0\n"));
  EXPECT_THAT(content(folder.file("err")), HasSubstr("exist"));
  EXPECT_THAT(content(out + "/report.html"), HasSubstr("</html>"));
  EXPECT_EQ(folder.n_entries(), 3U);
}

TEST(Faults, NamesMayBeLongAndForeign) {
  const Folder folder;
  std::string name = "wind und Schwingung, größte Stufe";
  std::string deep = folder.file(name);
  for (int i = 0; i < 6; ++i) deep += "/" + std::string(60, 'd');
  fs::create_directories(deep);
  const std::string record = record_in(folder), file = deep + "/Aufnahme 1.mat";
  const auto written = vibrissa("convert '" + record + "' '" + file + "'");
  ASSERT_EQ(written.status, 0) << written.errors;
  const auto back = vibrissa("convert '" + file + "' '" + deep + "/back.csv'");
  ASSERT_EQ(back.status, 0) << back.errors;
  EXPECT_THAT(content(deep + "/back.csv"), HasSubstr("base_acceleration_m_s2"));

  const auto too_long =
      vibrissa("convert '" + record + "' '" + folder.file(std::string(300, 'x') + ".csv") + "'");
  EXPECT_EQ(too_long.status, 2);
  EXPECT_THAT(too_long.errors, HasSubstr("too long"));
}

}  // namespace
}  // namespace vibrissa::apps
