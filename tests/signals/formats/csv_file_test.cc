#include "signals/formats/csv_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "signals/base/error.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class CsvFileTest : public ::testing::Test {
 protected:
  CsvFile opened(const std::string& content) const {
    return CsvFile(folder_.file("r.csv", content));
  }

  static std::vector<std::string> rows(const CsvFile& file, const std::size_t first,
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
    const CsvFile file = opened(content);
    return rows(file, 1, file.n_rows());
  }

  test::TemporaryFolder folder_;
};

TEST_F(CsvFileTest, SplitsLinesAtCommas) {
  const CsvFile file = opened("a,b\n1,2\n3,4\n");
  EXPECT_THAT(file.columns(), ElementsAre("a", "b"));
  EXPECT_EQ(file.n_rows(), 2u);
  EXPECT_THAT(rows(file, 1, 2), ElementsAre("2:<1><2>", "3:<3><4>"));
}

TEST_F(CsvFileTest, DoesNotCareHowLinesAndTheFileEnd) {
  for (const char* const content : {"a,b\n1,2\n3,4", "a,b\n1,2\n3,4\n\n", "a,b\r\n1,2\r\n3,4\r\n",
                                    "a,b\r\n1,2\r\n3,4\r\n\r\n \r\n",
                                    "\xEF\xBB\xBF"
                                    "a,b\n1,2\n3,4\n"}) {
    EXPECT_THAT(opened(content).columns(), ElementsAre("a", "b")) << content;
    EXPECT_THAT(all_rows(content), ElementsAre("2:<1><2>", "3:<3><4>")) << content;
  }
}

TEST_F(CsvFileTest, TakesSpacesAndTabsAroundFieldsAway) {
  EXPECT_THAT(opened(" a , b\t\n1,2\n").columns(), ElementsAre("a", "b"));
  EXPECT_THAT(all_rows("a,b\n  1 ,\t2  \n"), ElementsAre("2:<1><2>"));
}

TEST_F(CsvFileTest, TakesQuotesAwayAndKeepsCommasInThem) {
  EXPECT_THAT(opened("\"a\", \"b, \"\"c\"\"\" ,d\n1,2,3\n").columns(),
              ElementsAre("a", "b, \"c\"", "d"));
  EXPECT_THAT(all_rows("a,b\n\"1.5\",\"x, y\"\n"), ElementsAre("2:<1.5><x, y>"));
  EXPECT_THAT(all_rows("a,b\n5\" pipe,2\n"), ElementsAre("2:<5\" pipe><2>"));
}

TEST_F(CsvFileTest, KeepsEmptyFieldsAlsoTheLast) {
  EXPECT_THAT(all_rows("a,b,c\n,2,\n"), ElementsAre("2:<><2><>"));
}

TEST_F(CsvFileTest, VisitsOnlyTheRowsAskedFor) {
  const CsvFile file = opened("a,b\nbroken\n3,4\n5,6\nbroken\n");
  EXPECT_EQ(file.n_rows(), 4u);
  EXPECT_THAT(rows(file, 2, 2), ElementsAre("3:<3><4>", "4:<5><6>"));
  EXPECT_THAT(rows(file, 5, 0), ElementsAre());
}

TEST_F(CsvFileTest, RefusesARowOfAnotherLengthWithItsLine) {
  EXPECT_THAT(
      [&] { all_rows("a,b\n1,2\n3\n"); },
      ThrowsMessage<UserError>(EndsWith("r.csv:3: 1 field, but the first line names 2 columns")));
  EXPECT_THAT(
      [&] { all_rows("a,b\n1,2,3\n"); },
      ThrowsMessage<UserError>(EndsWith("r.csv:2: 3 fields, but the first line names 2 columns")));
  EXPECT_THAT([&] { all_rows("a,b\n\"1,2\n"); },
              ThrowsMessage<UserError>(HasSubstr("r.csv:2: 1 field, but")));
}

TEST_F(CsvFileTest, RefusesABlankLineAmongTheData) {
  EXPECT_THAT([&] { all_rows("a,b\n1,2\n\n3,4\n"); },
              ThrowsMessage<UserError>(HasSubstr("r.csv:3: blank line between the data")));
  EXPECT_THAT([&] { all_rows("a\n1\n \n3\n"); },
              ThrowsMessage<UserError>(HasSubstr("r.csv:3: blank line between the data")));
}

TEST_F(CsvFileTest, HintsAtTheNearestColumnAndListsAll) {
  const CsvFile file = opened("x_mps2,y_mps2,name\n1,2,3\n");
  EXPECT_EQ(file.index_of("y_mps2"), 1u);
  EXPECT_TRUE(file.has("name"));
  EXPECT_FALSE(file.has("z_mps2"));
  EXPECT_THAT(
      [&] { file.index_of("nam"); },
      ThrowsMessage<UserError>(EndsWith("r.csv:1: unknown column 'nam'; did you mean 'name'? "
                                        "Known: x_mps2, y_mps2, name")));
}

TEST_F(CsvFileTest, RefusesARepeatedColumnButNotSeveralWithoutAName) {
  EXPECT_THAT(
      [&] { opened("a,b,a\n1,2,3\n"); },
      ThrowsMessage<UserError>(EndsWith("r.csv:1: columns 1 and 3 have the same name 'a'")));
  const CsvFile file = opened("a,,\n1,,\n");
  EXPECT_THAT(file.columns(), ElementsAre("a", "", ""));
  EXPECT_THAT([&] { file.index_of(""); }, ThrowsMessage<UserError>(HasSubstr("unknown column ''")));
}

TEST_F(CsvFileTest, RefusesAFileWithoutColumnNames) {
  EXPECT_THAT([&] { opened("0.002,1e-3\n0.004,2\n"); },
              ThrowsMessage<UserError>(HasSubstr("r.csv:1: the first line contains numbers")));
  EXPECT_THAT([&] { opened("\na,b\n1,2\n"); },
              ThrowsMessage<UserError>(HasSubstr("r.csv:1: the first line is blank")));
}

TEST_F(CsvFileTest, LeavesOutCommentsBeforeTheNames) {
  const CsvFile file = opened("# logger 3\n#\nt,ax\n0,1\n1,2\n");
  EXPECT_THAT(file.columns(), ElementsAre("t", "ax"));
  EXPECT_EQ(file.n_rows(), 2u);
  EXPECT_EQ(file.line_of(1), 4u);
  EXPECT_THAT([&] { all_rows("# a\nb\n1\n2,3\n"); },
              ThrowsMessage<UserError>(HasSubstr("r.csv:4: 2 fields")));
}

TEST_F(CsvFileTest, TakesNamesFromACommentBeforeNumbers) {
  const CsvFile file = opened("# logger 3\n# t, ax\n0,1\n1,2\n");
  EXPECT_THAT(file.columns(), ElementsAre("t", "ax"));
  EXPECT_EQ(file.n_rows(), 2u);
  EXPECT_EQ(file.line_of(1), 3u);
  EXPECT_THAT([&] { opened("# logger 3\n0,1\n1,2\n"); },
              ThrowsMessage<UserError>(HasSubstr("r.csv:2: the first line contains numbers")));
  EXPECT_THAT([&] { opened("# a\n# b\n"); }, ThrowsMessage<UserError>(HasSubstr("is empty")));
}

TEST_F(CsvFileTest, NamesAnotherSeparator) {
  EXPECT_THAT([&] { opened("time_s;z_mps2\n0,1;2,5\n"); },
              ThrowsMessage<UserError>(HasSubstr("separated by semicolons")));
  EXPECT_THAT([&] { opened("time_s\tz_mps2\n0.1\t2.5\n"); },
              ThrowsMessage<UserError>(HasSubstr("separated by tabs")));
}

TEST_F(CsvFileTest, RefusesAnEmptyFile) {
  for (const char* const content : {"", "\n\n", "\xEF\xBB\xBF", "\xEF\xBB\xBF\r\n"})
    EXPECT_THAT([&] { opened(content); },
                ThrowsMessage<UserError>(EndsWith("r.csv: the file is empty")));
}

TEST_F(CsvFileTest, TakesAFileWithoutRows) {
  EXPECT_EQ(opened("a,b\n").n_rows(), 0u);
}

TEST_F(CsvFileTest, SaysWhyAFileCannotBeRead) {
  EXPECT_THAT([&] { CsvFile(folder_.path() / "none.csv"); },
              ThrowsMessage<UserError>(
                  AllOf(HasSubstr("none.csv: cannot be read"), HasSubstr("No such file"))));
  EXPECT_THAT([&] { CsvFile(folder_.path()); }, ThrowsMessage<UserError>(HasSubstr("is a folder")));
}

TEST_F(CsvFileTest, DoesNotCrashOnBytesThatAreNoText) {
  std::string bytes;
  for (int i = 0; i < 100000; ++i) bytes += static_cast<char>((i * 7919 + i / 256) % 256);
  EXPECT_THROW(all_rows(bytes), UserError);
  EXPECT_THROW(all_rows("a,b\n" + bytes), UserError);
}

}  // namespace
}  // namespace vibrissa::signals
