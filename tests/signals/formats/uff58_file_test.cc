#include "signals/formats/uff58_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <fstream>

#include "signals/base/error.h"
#include "signals/formats/uff58/uff58_record.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals::formats {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// Written by hand from the definition of the format, field by field.
const std::string head_of_a_frf =
    "    -1\n"
    "    58\n"
    "Hammer test\n"
    "NONE\n"
    "10-Jan-20 10:00:00\n"
    "NONE\n"
    "NONE\n"
    "    4         1    0         0 TIP               12   3 BASE               1  -3\n"
    "         5         3         1  1.00000E+01  2.50000E-01  0.00000E+00\n"
    "        18    0    0    0 Frequency            Hz                  \n"
    "        12    0    0    0 Acceleration         m/s^2               \n"
    "        13    0    0    0 Force                N                   \n"
    "         0    0    0    0 NONE                 NONE                \n";

TEST(Uff58, ReadsAResponseWrittenByHand) {
  const auto functions = parse_uff58(
      head_of_a_frf +
          "  1.00000E+00  2.00000E+00  3.00000E+00 -4.00000E-01  5.0000D+001  6.00000-101\n"
          "    -1\n",
      "frf.uff");
  ASSERT_EQ(functions.size(), 1u);
  const Uff58Function& frf = functions[0];
  EXPECT_EQ(frf.id_lines[0], "Hammer test");
  EXPECT_EQ(frf.function_type, 4);
  EXPECT_EQ(frf.response_node, 12);
  EXPECT_EQ(frf.response_direction, 3);
  EXPECT_EQ(frf.reference_direction, -3);
  EXPECT_EQ(frf.abscissa_start, 10.);
  EXPECT_EQ(frf.abscissa_step, 0.25);
  EXPECT_EQ(frf.ordinate_axis.unit, "m/s^2");
  EXPECT_EQ(frf.denominator_axis.label, "Force");
  ASSERT_EQ(frf.values.size(), 3u);
  EXPECT_EQ(frf.values[1], std::complex<double>(3., -0.4));
  EXPECT_EQ(frf.values[2], std::complex<double>(50., 6e-101));
}

TEST(Uff58, ReadsBinaryValuesOfEitherByteOrder) {
  for (const bool big : {false, true}) {
    std::string head = head_of_a_frf;
    const auto at = head.find("    58\n");
    head.replace(at, 7,
                 std::string("    58b     ") + (big ? "2" : "1") +
                     "     2          11          24     0     0           0           0\n");
    std::string values;
    for (const float number : {1.f, 2.f, 3.f, -0.5f, 5.f, 6.f}) {
      auto bits = std::bit_cast<std::uint32_t>(number);
      if (big) bits = __builtin_bswap32(bits);
      values.append(reinterpret_cast<const char*>(&bits), sizeof bits);
    }
    const auto functions = parse_uff58(head + values + "\n    -1\n", "frf.uff");
    ASSERT_EQ(functions.size(), 1u);
    EXPECT_EQ(functions[0].values[1], std::complex<double>(3., -0.5));
  }
}

TEST(Uff58, SkipsOtherDataSets) {
  const std::string nodes = "    -1\n   151\nmodel\n    -1\n";
  std::string line;
  for (int i = 0; i < 6; ++i) line += "  1.00000E+00";
  EXPECT_EQ(parse_uff58(nodes + head_of_a_frf + line + "\n    -1\n" + nodes, "x").size(), 1u);
}

TEST(Uff58, KeepsAResponseThatItWrites) {
  test::TemporaryFolder folder;
  Uff58Function frf;
  frf.id_lines[0] = "base_moment_N_m / base_acceleration_m_s2";
  frf.function_type = 4;
  frf.is_complex = true;
  frf.abscissa_start = 1.25;
  frf.abscissa_step = 0.5;
  frf.abscissa_axis = {.quantity = 18, .label = "Frequency", .unit = "Hz"};
  for (int i = 0; i < 7; ++i) frf.values.emplace_back(1. / (i + 1.), -1e-7 * i);
  Uff58Function uneven = frf;
  uneven.abscissa = {1., 2., 4., 8., 16., 32., 64.};
  write_uff58(folder.path() / "frf.uff", {frf, uneven});
  const auto read = read_uff58(folder.path() / "frf.uff");
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].id_lines[0], frf.id_lines[0]);
  EXPECT_EQ(read[1].abscissa, uneven.abscissa);
  for (const Uff58Function& function : read)
    for (std::size_t i = 0; i < frf.values.size(); ++i)
      EXPECT_LE(std::abs(function.values[i] - frf.values[i]), 1e-12);
}

// Column by column, as a Fortran program reads it.
TEST(Uff58, PutsEveryFieldWhereTheFormatHasIt) {
  test::TemporaryFolder folder;
  Record record(500., 64, 2.);
  record.set_channel(channel::base_moment, std::vector<double>(64, -1.5e-4));
  write_uff58(folder.path() / "r.uff", record);
  std::ifstream in(folder.path() / "r.uff");
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  ASSERT_EQ(lines[0], "    -1");
  ASSERT_EQ(lines[1], "   164");
  const std::size_t at = 7;
  ASSERT_EQ(lines[at], "    58");
  EXPECT_EQ(lines[at + 1], "base_moment_N_m");
  EXPECT_EQ(lines[at + 6].substr(0, 5), "    1");
  EXPECT_EQ(lines[at + 6].substr(41, 10), "         1");
  EXPECT_EQ(lines[at + 7].substr(0, 30), "         4        64         1");
  EXPECT_EQ(lines[at + 7].substr(30, 26), "  2.00000E+00  2.00000E-03");
  EXPECT_EQ(lines[at + 8].substr(0, 10), "        17");
  EXPECT_EQ(lines[at + 9].substr(0, 25), "         9    1    1    0");
  EXPECT_EQ(lines[at + 9].substr(47, 3), "N m");
  EXPECT_EQ(lines[at + 12].substr(0, 20), " -1.500000000000E-04");
  EXPECT_EQ(lines[at + 12].size(), 80u);
  EXPECT_EQ(lines.back(), "    -1");
}

TEST(Uff58, RefusesWhatIsDamaged) {
  const auto refuses = [](const std::string& text, const std::string& reason) {
    EXPECT_THAT([&] { parse_uff58(text, "bad.uff"); }, ThrowsMessage<UserError>(HasSubstr(reason)));
  };
  refuses("hello\n", "contains no function of type 58");
  refuses(head_of_a_frf + "  1.00000E+00\n", "the file ends within a function");
  refuses(head_of_a_frf + "  1.00000E+00  x\n", "bad.uff:14: 'x' is not a number");
  std::string many = head_of_a_frf;
  many.replace(many.find("         5         3"), 20, "         52000000000");
  refuses(many, "the number of points 2000000000");
}

}  // namespace
}  // namespace vibrissa::signals::formats
