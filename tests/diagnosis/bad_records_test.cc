#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "diagnosis/diagnosis.h"
#include "signals/base/error.h"
#include "signals/files/record_io.h"
#include "tests/diagnosis/one_mode_rig.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::diagnosis {
namespace {

using testing::HasSubstr;

/// A dataset on disk whose files are damaged before it is read and diagnosed.
class BadRecords : public testing::Test {
 protected:
  BadRecords() {
    nlohmann::json records = nlohmann::json::array();
    for (const signals::DatasetRecord& entry : test::rig_dataset(test::noisy_rig()).records) {
      signals::write_record(folder_.path() / (entry.name + ".csv"), entry.record);
      records.push_back({{"file", entry.name + ".csv"},
                         {"excitation", to_string(entry.excitation)},
                         {"period_samples", entry.period_samples},
                         {"split", entry.split == signals::Split::fit ? "fit" : "held_out"}});
    }
    folder_.file("dataset.json",
                 nlohmann::json{{"schema", "vibrissa-dataset-1"}, {"records", records}}.dump());
  }

  using Lines = std::vector<std::string>;
  void damage(const std::function<void(Lines&)>& change) const {
    std::istringstream in(signals::test::content_of(folder_.path() / "base_high.csv"));
    Lines lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    change(lines);
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    folder_.file("base_high.csv", text);
  }

  void expect_refused(const std::vector<std::string>& words) const {
    try {
      diagnose(test::nominal_of(test::OneModeRig{}, false), signals::read_dataset(folder_.path()),
               {.search = {.max_effects = 1}});
      FAIL() << "was accepted";
    } catch (const signals::UserError& error) {
      for (const std::string& word : words) EXPECT_THAT(error.what(), HasSubstr(word));
    }
  }

  signals::test::TemporaryFolder folder_;
};

TEST_F(BadRecords, AreReadWhenTheyAreNotBad) {
  EXPECT_EQ(signals::read_dataset(folder_.path()).records.size(), 4u);
}

TEST_F(BadRecords, NaNIsNamedWithFileLineAndColumn) {
  damage([](Lines& lines) { lines[77].replace(lines[77].rfind(','), std::string::npos, ",nan"); });
  expect_refused({"base_high.csv:78: ", "column 'base_moment_N_m'", "'nan' is not finite",
                  "choose rows without missing samples"});
}

TEST_F(BadRecords, AnEmptyFieldIsNamedWithFileLineAndColumn) {
  damage([](Lines& lines) { lines[77].erase(lines[77].rfind(',') + 1); });
  expect_refused({"base_high.csv:78: ", "column 'base_moment_N_m'", "the field is empty"});
}

TEST_F(BadRecords, AGapInTimeIsNamedWithFileLinesAndColumn) {
  damage([](Lines& lines) { lines.erase(lines.begin() + 301, lines.begin() + 401); });
  expect_refused({"base_high.csv: gap in time between line 301 ", "and line 302 ",
                  "101 sampling intervals where 1 was expected", "column 'time_s'",
                  "never added or removed"});
}

TEST_F(BadRecords, RowsTwiceAreNamedWithFileLinesAndColumn) {
  damage([](Lines& lines) { lines.insert(lines.begin() + 100, lines[99]); });
  expect_refused({"base_high.csv: time does not increase between line 100 ", "column 'time_s'"});
}

TEST_F(BadRecords, ADeadSensorIsNamedWithItsRecord) {
  damage([](Lines& lines) {
    for (std::size_t i = 1; i < lines.size(); ++i)
      lines[i].replace(lines[i].rfind(','), std::string::npos, ",0");
  });
  expect_refused({"base_high: base_moment_N_m is constant at 0"});
}

}  // namespace
}  // namespace vibrissa::diagnosis
