#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/separation/test_signals.h"

namespace vibrissa::separation::test {

inline constexpr const char* c_program = R"(
#include "model.h"
#include <stdio.h>
int main(int argc, char **argv) {
  sensor_state state;
  double x;
  FILE *in = fopen(argv[1], "r"), *out = fopen(argv[2], "w");
  (void)argc;
  sensor_reset(&state);
  while (fscanf(in, "%lf", &x) == 1) fprintf(out, "%.9g\n", sensor_step(&state, (float)x));
  return fclose(out);
}
)";

/// What a header of the name "sensor" gives for this input, compiled by the C compiler with all
/// warnings as errors.
inline Signal run_in_c(const std::string& header, const Signal& input) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("vibrissa_c_header_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "model.h") << header;
  std::ofstream(folder / "main.c") << c_program;
  std::ofstream samples(folder / "in");
  samples.precision(17);
  for (const double x : input) samples << x << '\n';
  samples.close();
  const std::string in = "'" + folder.string() + "/";
  const std::string build = std::string(VIBRISSA_C_COMPILER) +
                            " -std=c99 -Wall -Wextra -Werror -pedantic -O1 -o " + in + "run' " +
                            in + "main.c'";
  EXPECT_EQ(std::system(build.c_str()), 0);
  EXPECT_EQ(std::system((in + "run' " + in + "in' " + in + "out'").c_str()), 0);
  Signal output;
  std::ifstream results(folder / "out");
  for (double y = 0.; results >> y;) output.push_back(y);
  std::filesystem::remove_all(folder);
  return output;
}

inline double largest_relative_error(const Signal& output, const Signal& expected) {
  double largest = 0.;
  for (std::size_t i = 0; i < expected.size(); ++i)
    largest = std::max(largest, std::abs(output[i] - expected[i]));
  return largest / rms(expected);
}

}  // namespace vibrissa::separation::test
