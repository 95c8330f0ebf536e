#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/files/record_io.h"
#include "signals/formats/text/text_file.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr const char* end_of_header = "***End_of_Header***\t\n";

std::string with_mark(std::string text, const char decimal) {
  if (decimal == ',') std::replace(text.begin(), text.end(), '.', ',');
  return text;
}

struct LabviewFile {
  std::string x_columns = "No";
  char decimal = '.';
  std::string step = "0.000977";
  std::size_t n_samples = 200, n_rows = 200;
  bool comments = false;
};

// Two channels in g and N m.
std::string text_of(const LabviewFile& file) {
  std::string text = "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\n";
  text += std::string("Decimal_Separator\t") + file.decimal + "\nMulti_Headings\tYes\nX_Columns\t" +
          file.x_columns + "\n" + end_of_header + "\t\n";
  const std::string gap = file.x_columns == "Multi" ? "\t" : "";
  const std::string n = std::to_string(file.n_samples);
  const std::string step = with_mark(file.step, file.decimal);
  text += "Channels\t2\t\t\nSamples\t" + n + "\t" + gap + n + "\t\n";
  text += "Y_Unit_Label\tg\t" + gap + "Newton meter\t\nX_Dimension\tTime\t" + gap + "Time\t\n";
  text += with_mark("X0\t0.0E+0\t" + gap + "0.0E+0\t\n", file.decimal);
  text += "Delta_X\t" + step + "\t" + gap + step + "\t\n" + end_of_header;
  text += "X_Value\ta\t" + std::string(gap.empty() ? "" : "X_Value\t") + "m\tComment\n";
  for (std::size_t i = 0; i < file.n_rows; ++i) {
    const std::string time = to_text(double(i) / 1024.);
    const std::string x = file.x_columns == "No" ? "" : with_mark(time, file.decimal);
    text += x + "\t" + with_mark("0.5", file.decimal) + "\t" + (gap.empty() ? "" : x + "\t") +
            with_mark(std::to_string(i) + ".25", file.decimal) +
            (file.comments ? "\tlost communication" : "") + "\n";
  }
  return text;
}

Record read(const LabviewFile& file, const ReadOptions& options = {}) {
  const test::TemporaryFolder folder;
  ReadOptions all = options;
  all.columns = {parse_column_choice("base_acceleration=a"), parse_column_choice("base_moment=m")};
  return read_record(folder.file("r.lvm", text_of(file)), all);
}

TEST(LabviewFile, IsReadWithoutOneAndSeveralColumnsOfX) {
  for (const char decimal : {'.', ','})
    for (const std::string x_columns : {"No", "One", "Multi"})
      for (const bool comments : {false, true}) {
        SCOPED_TRACE(x_columns + decimal);
        const Record record =
            read({.x_columns = x_columns, .decimal = decimal, .comments = comments});
        EXPECT_EQ(record.sampling_rate_hz(), 1024.) << "the step 0.000977 is rounded";
        EXPECT_EQ(record.n_samples(), 200u);
        EXPECT_DOUBLE_EQ(record.channel(channel::base_acceleration)[3], 0.5 * 9.80665);
        EXPECT_EQ(record.channel(channel::base_moment)[199], 199.25);
      }
}

TEST(LabviewFile, TellsBlocksApartThatHaveNoHeaderBetween) {
  const LabviewFile glued{.n_samples = 128, .n_rows = 300};
  EXPECT_THAT([&] { read(glued); },
              ThrowsMessage<UserError>(HasSubstr("contains 3 recordings, the second from line")));
  EXPECT_EQ(read(glued, {.gaps = Gaps::pieces}).n_samples(), 128u);
  EXPECT_EQ(read(glued, {.first_row = 129, .n_rows = 128}).channel(channel::base_moment)[0],
            128.25);
}

TEST(LabviewFile, TellsBlocksApartByTheirHeaders) {
  const test::TemporaryFolder folder;
  const std::string one = text_of({.x_columns = "One", .n_samples = 70, .n_rows = 70});
  const std::string second = one.substr(one.find("Channels"));
  const formats::TextFile file(folder.file("r.lvm", one + "\n" + second));
  EXPECT_EQ(file.n_rows(), 140u);
  EXPECT_THAT(file.block_starts(), ElementsAre(1u, 71u));
}

/// a at 1000 Hz and m at 500 Hz, half as many; the third channel is as slow as a thermometer.
std::string text_of_two_rates() {
  std::string text = "LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t.\nX_Columns\tNo\n";
  text += std::string(end_of_header) + "\t\nChannels\t3\t\t\nSamples\t2000\t1000\t2\t\n";
  text += "Y_Unit_Label\tm/s^2\tN*m\tdegC\t\nX0\t0\t0\t0\t\nDelta_X\t0.001\t0.002\t1\t\n";
  text += std::string(end_of_header) + "X_Value\ta\tm\tT\tComment\n";
  for (int i = 0; i < 2000; ++i) {
    const auto motion = [](const double t) { return std::sin(2. * M_PI * 31. * t); };
    text += "\t" + to_text(motion(i / 1000.)) + "\t" + (i < 1000 ? to_text(motion(i / 500.)) : "") +
            "\t" + (i < 2 ? "21" : "") + "\n";
  }
  return text;
}

TEST(LabviewFile, PutsChannelsOfDifferentRatesOnOneClock) {
  const test::TemporaryFolder folder;
  const auto file = folder.file("r.lvm", text_of_two_rates());
  const ReadOptions both{.columns = {parse_column_choice("base_acceleration=a"),
                                     parse_column_choice("base_moment=m")}};
  const Recording recording = read_recording(file, both);
  EXPECT_THAT(recording.words, HasSubstr("channels at 1000, 500 Hz joined"));
  const Record& record = recording.pieces.front();
  EXPECT_EQ(record.sampling_rate_hz(), 500.);
  EXPECT_GT(record.n_samples(), 900u);
  const auto a = record.channel(channel::base_acceleration);
  const auto m = record.channel(channel::base_moment);
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    ASSERT_NEAR(m[i], std::sin(2. * M_PI * 31. * record.time_s(i)), 1e-6);
    ASSERT_NEAR(a[i], m[i], 2e-3);
  }
  const Record fast = read_record(file, {.columns = {parse_column_choice("base_acceleration=a")}});
  EXPECT_EQ(fast.sampling_rate_hz(), 1000.);
  EXPECT_EQ(fast.n_samples(), 2000u);
}

TEST(LabviewFile, RefusesOptionsOfOneRateForSeveral) {
  const test::TemporaryFolder folder;
  const auto file = folder.file("r.lvm", text_of_two_rates());
  const auto refuse = [&](const ReadOptions& options, const std::string& words) {
    EXPECT_THAT([&] { read_recording(file, options); }, ThrowsMessage<UserError>(HasSubstr(words)));
  };
  const std::vector<ColumnChoice> a = {parse_column_choice("base_acceleration=a")};
  refuse({.columns = a, .sampling_rate_hz = 1000.}, "leave --rate out");
  refuse({.columns = a, .first_row = 5}, "leave --rows out");
  refuse({.columns = {parse_column_choice("base_acceleration=b")}}, "unknown column 'b'");
  refuse({.columns = {parse_column_choice("temperature=T")}}, "only 2");
}

}  // namespace
}  // namespace vibrissa::signals
