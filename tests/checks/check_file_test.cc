#include "checks/check_file.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "checks/numbered_reasons.h"
#include "checks/report_json.h"
#include "checks/report_text.h"
#include "signals/record/channel_name.h"
#include "tests/checks/record_generator.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::checks {
namespace {

using signals::test::TemporaryFolder;
using testing::HasSubstr;
using testing::SizeIs;

Serves serves(const CheckResult& result, std::size_t command) {
  return result.serves[command].serves;
}

TEST(CheckFile, ServesIdentifyAndSaysWhatADiagnosisWillLack) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "r.csv";
  signals::write_record(file, test::good_record(test::Drive::random, 8000));
  const CheckResult result = check_file(file, {});
  EXPECT_EQ(serves(result, 0), Serves::good);
  EXPECT_EQ(serves(result, 1), Serves::good);
  EXPECT_EQ(serves(result, 2), Serves::limited) << "no wind, one level, nothing at rest";
  EXPECT_TRUE(serves_all(result.serves));
  EXPECT_THAT(check_text(result), HasSubstr("no fit record at rest"));
}

std::size_t n_times(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

// The clipped channel concerns all four commands.
TEST(CheckFile, SaysEachReasonOnceAndNamesItByItsNumber) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "r.csv";
  signals::write_record(file, test::bad_record(test::Fault::clipped, 8004).record);
  const CheckResult result = check_file(file, {});
  const std::string text = check_text(result);
  EXPECT_EQ(n_times(text, "is clipped"), 1u) << text;
  EXPECT_EQ(n_times(text, "no fit record at rest"), 1u) << text;
  const auto& findings = result.records[0].findings;
  const auto clipped = std::ranges::find(findings, diagnosis::FindingKind::clipped_channel,
                                         [](const Finding& finding) { return finding.kind; });
  ASSERT_NE(clipped, findings.end());
  const NumberedReasons reasons(result);
  const auto number = reasons.of_finding(0, static_cast<std::size_t>(clipped - findings.begin()));
  ASSERT_TRUE(number);
  const std::string cited = "[" + std::to_string(*number) + "]";
  EXPECT_THAT(text, HasSubstr(cited + " limits: "));
  for (const CommandVerdict& verdict : result.serves)
    EXPECT_THAT(reasons.of_command(verdict), HasSubstr(cited)) << verdict.command;
}

TEST(CheckFile, ReadsColumnsThatAreNoChannelsUnderTheirNames) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "logger.csv";
  std::ofstream out(file);
  out << "t,ax,hall,remark\n";
  for (int i = 0; i < 200; ++i) out << 0.01 * i << "," << i % 7 << "," << i % 5 << ",ok\n";
  out.close();
  const CheckResult result = check_file(file, {});
  ASSERT_THAT(result.records, SizeIs(1));
  EXPECT_THAT(result.records[0].channels, SizeIs(2));
  for (std::size_t command = 0; command < 4; ++command)
    EXPECT_EQ(serves(result, command), Serves::no);
  EXPECT_THAT(check_text(result), HasSubstr("no column is base_moment_N_m"));
  EXPECT_TRUE(only_names_are_missing(result.records));
}

/// Time and two signals without names; the time has a gap.
std::string unnamed_columns() {
  std::string text;
  for (int i = 0; i < 400; ++i)
    text += std::to_string(0.01 * (i < 200 ? i : i + 7)) + "," + std::to_string(i % 7) + "," +
            std::to_string(i % 5) + "\n";
  return text;
}

TEST(CheckFile, SaysOnceWhatAllPiecesHave) {
  const TemporaryFolder folder;
  const CheckResult result =
      check_file(folder.file("unnamed.csv", unnamed_columns()),
                 {.columns = {{signals::time_channel, "column_1"}}, .gaps = signals::Gaps::pieces});
  ASSERT_THAT(result.records, SizeIs(2));
  const std::string text = check_text(result);
  EXPECT_EQ(n_times(text, "no column is base_moment_N_m"), 1u) << text;
  EXPECT_THAT(text, HasSubstr("as above: [1] [2]"));
  EXPECT_THAT(text, HasSubstr("diagnose  no: [1] [2]\n"));
}

TEST(CheckFile, ListsColumnsWithoutNamesWhereOnlyTheTimeIsChosen) {
  const TemporaryFolder folder;
  const CheckResult result =
      check_file(folder.file("unnamed.csv", unnamed_columns()),
                 {.columns = {{signals::time_channel, "column_1"}}, .gaps = signals::Gaps::pieces});
  EXPECT_THAT(result.records, SizeIs(2)) << "two pieces";
  EXPECT_THAT(result.records[0].channels, SizeIs(2));
  EXPECT_TRUE(only_names_are_missing(result.records));
}

TEST(CheckFile, CallsAColumnThatNeverFallsATimeAndNoDrift) {
  const TemporaryFolder folder;
  const std::string text = check_text(
      check_file(folder.file("unnamed.csv", unnamed_columns()), {.sampling_rate_hz = 100.}));
  EXPECT_THAT(text, testing::AllOf(HasSubstr("column_1 rises from 0 to 4.06 and never falls"),
                                   testing::Not(HasSubstr("warm the electronics"))));
}

TEST(CheckFile, TakesAllRecordsOfADatasetTogether) {
  const TemporaryFolder folder;
  signals::write_record(folder.path() / "good.csv", test::good_record(test::Drive::random, 8001));
  signals::write_record(folder.path() / "dead.csv",
                        test::bad_record(test::Fault::dead_moment, 8002).record);
  std::ofstream(folder.path() / "dataset.json") << R"({"schema": "vibrissa-dataset-1", "records": [
             {"file": "good.csv", "excitation": "base"},
             {"file": "dead.csv", "excitation": "base"}]})";
  const CheckResult result = check_file(folder.path() / "dataset.json", {});
  ASSERT_THAT(result.records, SizeIs(2));
  EXPECT_EQ(serves(result, 0), Serves::good) << "one record is enough";
  EXPECT_EQ(serves(result, 2), Serves::no) << "diagnose refuses a constant channel";
  EXPECT_EQ(n_times(check_text(result), "read as: "), 2u) << check_text(result);
}

TEST(CheckFile, HasAJsonDocumentWithTheSameVerdicts) {
  const auto result = check_one("r", test::bad_record(test::Fault::clipped, 8003).record);
  const nlohmann::json document = check_json(result);
  EXPECT_EQ(document["schema"], "vibrissa-check-1");
  for (const CommandVerdict& verdict : result.serves)
    EXPECT_EQ(document["serves"][verdict.command]["verdict"], to_string(verdict.serves));
  EXPECT_EQ(document["records"][0]["findings"][0]["kind"], "clipped_channel");
}

}  // namespace
}  // namespace vibrissa::checks
