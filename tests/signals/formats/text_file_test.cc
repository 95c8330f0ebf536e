#include "signals/formats/text/text_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "signals/base/error.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals::formats {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class TextFileTest : public ::testing::Test {
 protected:
  TextFile opened(const std::string& content) const {
    return TextFile(folder_.file("r.csv", content));
  }

  static std::vector<std::string> rows(const TextFile& file, const std::size_t first,
                                       const std::size_t count) {
    std::vector<std::string> result;
    file.for_each_row(first, count, [&](const std::size_t line, const auto fields) {
      std::string row = std::to_string(line) + ":";
      for (const std::string_view field : fields) row.append("<").append(field).append(">");
      result.push_back(row);
    });
    return result;
  }

  std::vector<std::string> all_rows(const std::string& content) const {
    const TextFile file = opened(content);
    return rows(file, 1, file.n_rows());
  }

  test::TemporaryFolder folder_;
};

TEST_F(TextFileTest, SplitsLinesAtCommas) {
  const TextFile file = opened("a,b\n1,2\n3,4\n");
  EXPECT_THAT(file.columns(), ElementsAre("a", "b"));
  EXPECT_EQ(file.n_rows(), 2u);
  EXPECT_THAT(rows(file, 1, 2), ElementsAre("2:<1><2>", "3:<3><4>"));
}

TEST_F(TextFileTest, DoesNotCareHowLinesAndTheFileEnd) {
  for (const char* const content : {"a,b\n1,2\n3,4", "a,b\n1,2\n3,4\n\n", "a,b\r\n1,2\r\n3,4\r\n",
                                    "a,b\r\n1,2\r\n3,4\r\n\r\n \r\n",
                                    "\xEF\xBB\xBF"
                                    "a,b\n1,2\n3,4\n"}) {
    EXPECT_THAT(opened(content).columns(), ElementsAre("a", "b")) << content;
    EXPECT_THAT(all_rows(content), ElementsAre("2:<1><2>", "3:<3><4>")) << content;
  }
}

TEST_F(TextFileTest, TakesSpacesAndTabsAroundFieldsAway) {
  EXPECT_THAT(opened(" a , b\t\n1,2\n").columns(), ElementsAre("a", "b"));
  EXPECT_THAT(all_rows("a,b\n  1 ,\t2  \n"), ElementsAre("2:<1><2>"));
}

TEST_F(TextFileTest, TakesQuotesAwayAndKeepsCommasInThem) {
  EXPECT_THAT(opened("\"a\", \"b, \"\"c\"\"\" ,d\n1,2,3\n").columns(),
              ElementsAre("a", "b, \"c\"", "d"));
  EXPECT_THAT(all_rows("a,b\n\"1.5\",\"x, y\"\n"), ElementsAre("2:<1.5><x, y>"));
  EXPECT_THAT(all_rows("a,b\n5\" pipe,2\n"), ElementsAre("2:<5\" pipe><2>"));
}

TEST_F(TextFileTest, KeepsEmptyFieldsAlsoTheLast) {
  EXPECT_THAT(all_rows("a,b,c\n,2,\n"), ElementsAre("2:<><2><>"));
}

TEST_F(TextFileTest, VisitsOnlyTheRowsAskedFor) {
  const TextFile file = opened("a,b\nbroken\n3,4\n5,6\nbroken\n");
  EXPECT_EQ(file.n_rows(), 4u);
  EXPECT_THAT(rows(file, 2, 2), ElementsAre("3:<3><4>", "4:<5><6>"));
  EXPECT_THAT(rows(file, 5, 0), ElementsAre());
}

TEST_F(TextFileTest, RefusesARowOfAnotherLengthWithItsLine) {
  EXPECT_THAT(
      [&] { all_rows("a,b\n1,2\n3\n"); },
      ThrowsMessage<UserError>(EndsWith("r.csv:3: 1 field, but the first line names 2 columns")));
  EXPECT_THAT(
      [&] { all_rows("a,b\n1,2,3\n"); },
      ThrowsMessage<UserError>(HasSubstr("r.csv:2: 3 fields, but the first line names 2 columns")));
  EXPECT_THAT([&] { all_rows("a,b\n\"1,2\n"); },
              ThrowsMessage<UserError>(HasSubstr("r.csv:2: 1 field, but")));
}

TEST_F(TextFileTest, PassesOverBlankLinesAndCommentsAmongTheData) {
  const std::string content = "a,b\n1,2\n\n3,4\n# paused\n# again\n5,6\n";
  EXPECT_THAT(all_rows(content), ElementsAre("2:<1><2>", "4:<3><4>", "7:<5><6>"));
  const TextFile file = opened(content);
  EXPECT_EQ(file.line_of(2), 4u);
  EXPECT_EQ(file.line_of(3), 7u);
  EXPECT_THAT(rows(file, 3, 1), ElementsAre("7:<5><6>"));
}

TEST_F(TextFileTest, NumbersRepeatedNamesSoThatNeitherIsTakenByAccident) {
  EXPECT_THAT(opened("a,b,a\n1,2,3\n").columns(), ElementsAre("a_1", "b", "a_2"));
  EXPECT_THAT(opened("a,b,a,a_1\n1,2,3,4\n").columns(), ElementsAre("a_2", "b", "a_3", "a_1"));
}

TEST_F(TextFileTest, NamesColumnsWithoutANameByTheirNumber) {
  EXPECT_THAT(opened("a,,\n1,2,\n").columns(), ElementsAre("a", "column_2", "column_3"));
  const TextFile file = opened("0.002,1e-3\n0.004,2\n");
  EXPECT_THAT(file.columns(), ElementsAre("column_1", "column_2"));
  EXPECT_EQ(file.n_rows(), 2u);
}

TEST_F(TextFileTest, LeavesOutBlankLinesBeforeTheNames) {
  const TextFile file = opened("\na,b\n1,2\n");
  EXPECT_THAT(file.columns(), ElementsAre("a", "b"));
  EXPECT_EQ(file.line_of(1), 3u);
}

TEST_F(TextFileTest, LeavesOutCommentsBeforeTheNames) {
  const TextFile file = opened("# logger 3\n#\nt,ax\n0,1\n1,2\n");
  EXPECT_THAT(file.columns(), ElementsAre("t", "ax"));
  EXPECT_EQ(file.n_rows(), 2u);
  EXPECT_EQ(file.line_of(1), 4u);
  EXPECT_THAT([&] { all_rows("# a\nb,c\n1,2\n2,3,4\n5,6\n"); },
              ThrowsMessage<UserError>(HasSubstr("r.csv:4: 3 fields")));
}

TEST_F(TextFileTest, TakesNamesFromACommentBeforeNumbers) {
  const TextFile file = opened("# logger 3\n# t, ax\n0,1\n1,2\n");
  EXPECT_THAT(file.columns(), ElementsAre("t", "ax"));
  EXPECT_EQ(file.n_rows(), 2u);
  EXPECT_EQ(file.line_of(1), 3u);
  EXPECT_THAT(opened("# logger 3\n0.5,1\n1.5,2\n").columns(), ElementsAre("column_1", "column_2"));
  EXPECT_THAT([&] { opened("# a\n# b\n"); }, ThrowsMessage<UserError>(HasSubstr("is empty")));
}

TEST_F(TextFileTest, RecognisesTheSeparatorAndTheDecimalMark) {
  EXPECT_THAT(all_rows("time_s;z_mps2\n0,1;2,5\n"), ElementsAre("2:<0,1><2,5>"));
  EXPECT_EQ(opened("time_s;z_mps2\n0,1;2,5\n").layout().spelling, (Spelling{';', ','}));
  EXPECT_EQ(opened("time_s\tz_mps2\n0.1\t2.5\n").layout().spelling, (Spelling{'\t', '.'}));
  EXPECT_EQ(opened("t ax\n0,1  2,5\n").layout().spelling, (Spelling{' ', ','}));
  EXPECT_EQ(opened("t,ax\n\"0,1\",\"2,5\"\n").layout().spelling, (Spelling{',', ','}));
  EXPECT_EQ(opened("ax\n1.5\n2.5\n").columns().size(), 1u);
}

TEST_F(TextFileTest, FindsDecimalCommasBehindManyWholeNumbers) {
  std::string text = "t;ax\n";
  for (int i = 0; i < 3000; ++i) text += std::to_string(i) + ";1\n";
  EXPECT_EQ(opened(text).layout().spelling, (Spelling{';', '.'}));
  EXPECT_EQ(opened(text + "3000;1,5\n").layout().spelling, (Spelling{';', ','}));
}

TEST_F(TextFileTest, RefusesATableThatCanBeReadInTwoWaysWithBothReadings) {
  const std::string text = "1,25\n2,75\n3,25\n";
  EXPECT_THAT([&] { opened(text); },
              ThrowsMessage<UserError>(AllOf(HasSubstr("r.csv:2: "), HasSubstr("give '2' '75'"),
                                             HasSubstr("give '2,75'"), HasSubstr("--separator"))));
  EXPECT_EQ(TextFile(folder_.file("r.csv", text), {.separator = ','}).columns().size(), 2u);
  EXPECT_EQ(TextFile(folder_.file("r.csv", text), {.decimal = ','}).columns().size(), 1u);
  EXPECT_EQ(opened("a,b\n" + text).columns().size(), 2u) << "two names tell";
}

TEST_F(TextFileTest, RefusesCommasThatSeparateAndMarkDecimals) {
  std::string text;
  for (int i = 0; i < 30; ++i) text += "0,0" + std::to_string(i) + ",-0,5,1,25\n";
  EXPECT_THAT([&] { opened(text); }, ThrowsMessage<UserError>(HasSubstr("decimal")));
  EXPECT_THAT([&] { opened("t,a,m\n" + text); }, ThrowsMessage<UserError>(HasSubstr("r.csv:")));
}

TEST_F(TextFileTest, LeavesOutLinesOfMetadataAndTakesUnits) {
  const TextFile file = opened(
      "Device: Logger 7,Serial 12\nStart: 2024-01-02 10:11:12\nt,ax,m\ns,m/s2,N m\n"
      "0,1.5,2\n1,2.5,3\n");
  EXPECT_THAT(file.columns(), ElementsAre("t", "ax", "m"));
  EXPECT_THAT(file.layout().units, ElementsAre("s", "m/s2", "N m"));
  EXPECT_EQ(file.line_of(1), 5u);
  EXPECT_EQ(to_string(file.layout()), "commas, decimal points, names in line 3, units in line 4");
}

TEST_F(TextFileTest, TakesTheNumberOfHeaderLinesThatIsGiven) {
  const std::string text = "a,b\nc,d\n0,1\n1,2\n";
  const TextFile file(folder_.file("r.csv", text), {.header_lines = 3});
  EXPECT_EQ(file.n_rows(), 1u);
  EXPECT_EQ(file.line_of(1), 4u);
  EXPECT_THAT(file.columns(), ElementsAre("c", "d"));
}

TEST_F(TextFileTest, KeepsBrokenRowsBehindTheNamesAsRows) {
  const TextFile file = opened("time_s,ax\n0.1,abc\n0.2,1.5\n0.3,2.5\n");
  EXPECT_EQ(file.n_rows(), 3u);
  EXPECT_EQ(file.line_of(1), 2u);
}

TEST_F(TextFileTest, TakesEmptyLastFieldsAndEmptyRowsAtTheEnd) {
  EXPECT_THAT(all_rows("t,ax,,\n0,1,,\n1,2,,\n,,,\n,,,\n"),
              ElementsAre("2:<0><1><><>", "3:<1><2><><>"));
  EXPECT_THAT(opened("t,ax\n0,1,\n1,2,\n").columns(), ElementsAre("t", "ax", "column_3"));
}

TEST_F(TextFileTest, ReadsUtf16AndLatin1) {
  const std::string plain = "Zeit [s];\u00B0;a\n0;1;2\n1;2;3\n";
  std::u16string wide = u"\uFEFFZeit [s];\u00B0;a\n0;1;2\n1;2;3\n";
  std::string little, big;
  for (const char16_t c : wide) {
    little += {static_cast<char>(c & 0xFF), static_cast<char>(c >> 8)};
    big += {static_cast<char>(c >> 8), static_cast<char>(c & 0xFF)};
  }
  const std::string latin_1 = "Zeit [s];\xB0;a\n0;1;2\n1;2;3\n";
  for (const std::string& text : {plain, little, big, little.substr(2), latin_1}) {
    EXPECT_THAT(opened(text).columns(), ElementsAre("Zeit [s]", "\u00B0", "a"));
    EXPECT_THAT(all_rows(text), ElementsAre("2:<0><1><2>", "3:<1><2><3>"));
  }
}

TEST_F(TextFileTest, FindsARateInACommentAndARateRow) {
  const auto rate = [&](const std::string& text) { return opened(text).layout().rate; };
  const std::string rows = "count,ax\n0,1\n1,3\n2,5\n";
  EXPECT_EQ(rate("# data_rate = 2000.0 Hz, filter = 488 Hz\n" + rows)->rate_hz, 2000.);
  EXPECT_EQ(rate("Sampling rate: 1.5 kHz\n" + rows)->rate_hz, 1500.);
  EXPECT_EQ(rate("# dt = 2 ms\n" + rows)->rate_hz, 500.);
  EXPECT_FALSE(rate("# filter = 488 Hz\n" + rows).has_value());
  const TextFile wearable = opened(
      "1560279825.0,1560279825.0,1560279825.0\n32.0,32.0,32.0\n-61,25,6\n-62,24,6\n-5,2,4\n");
  EXPECT_EQ(wearable.layout().rate->rate_hz, 32.);
  EXPECT_EQ(wearable.n_rows(), 3u);
}

TEST_F(TextFileTest, SeparatesRecordingsBehindRepeatedNames) {
  const TextFile file = opened("t,ax\n0,1\n1,2\nt,ax\n0,5\n1,6\n");
  EXPECT_EQ(file.n_rows(), 4u);
  EXPECT_THAT(file.block_starts(), ElementsAre(1u, 3u));
  EXPECT_THAT(rows(file, 3, 1), ElementsAre("5:<0><5>"));
}

TEST(TimeInText, IsReadInTheUsualSpellings) {
  EXPECT_EQ(time_in("1970-01-02T00:00:01.5Z"), 86401.5);
  EXPECT_EQ(time_in("1970/01/02 00:00:01,5"), 86401.5);
  EXPECT_EQ(time_in("1970-01-01T02:00:00+02:00"), 0.);
  EXPECT_EQ(time_in("1970-01-01T00.00.05.250"), 5.25);
  EXPECT_EQ(time_in("00:01:02.25"), 62.25);
  for (const char* const text : {"", "12", "1.5.2", "2024-13-01", "10:99:00", "x10:11:12"})
    EXPECT_FALSE(time_in(text).has_value()) << text;
}

TEST_F(TextFileTest, RefusesAnEmptyFile) {
  for (const char* const content : {"", "\n\n", "\xEF\xBB\xBF", "\xEF\xBB\xBF\r\n"})
    EXPECT_THAT([&] { opened(content); },
                ThrowsMessage<UserError>(EndsWith("r.csv: the file is empty")));
}

TEST_F(TextFileTest, TakesAFileWithoutRows) {
  EXPECT_EQ(opened("a,b\n").n_rows(), 0u);
}

TEST_F(TextFileTest, SaysWhyAFileCannotBeRead) {
  EXPECT_THAT([&] { TextFile(folder_.path() / "none.csv"); },
              ThrowsMessage<UserError>(
                  AllOf(HasSubstr("none.csv: cannot be read"), HasSubstr("No such file"))));
  EXPECT_THAT([&] { TextFile(folder_.path()); },
              ThrowsMessage<UserError>(HasSubstr("is a folder")));
}

TEST_F(TextFileTest, DoesNotCrashOnBytesThatAreNoText) {
  std::string bytes;
  for (int i = 0; i < 100000; ++i) bytes += static_cast<char>((i * 7919 + i / 256) % 256);
  EXPECT_THROW(all_rows(bytes), UserError);
  EXPECT_THROW(all_rows("a,b\n" + bytes), UserError);
}

}  // namespace
}  // namespace vibrissa::signals::formats
