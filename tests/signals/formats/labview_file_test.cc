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

TEST(LabviewFile, RefusesChannelsOfDifferentRates) {
  const test::TemporaryFolder folder;
  std::string text = text_of({});
  const std::size_t at = text.find("Delta_X\t0.000977\t0.000977");
  text.replace(at, 25, "Delta_X\t0.000977\t0.001954");
  EXPECT_THAT([&] { formats::TextFile file(folder.file("r.lvm", text)); },
              ThrowsMessage<UserError>(HasSubstr("different steps (0.000977 and 0.001954 s)")));
}

}  // namespace
}  // namespace vibrissa::signals
