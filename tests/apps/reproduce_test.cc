#include <gmock/gmock.h>

#include <map>

#include "tests/apps/program.h"

namespace vibrissa::apps {
namespace {

using nlohmann::json;

std::string flow_case() {
  return " --flow-case '" + case_file("flow_sensor.prm") + "'";
}

std::string cases() {
  return flow_case() + " --whisker-case '" + case_file("whisker_sensor.prm") + "'";
}

/// One reproduction, made once.
const Folder& reproduction() {
  static const Folder folder;
  static const bool made = [] {
    const auto result = vibrissa("reproduce" + cases() + " -o '" + folder.file("r") + "' --json");
    EXPECT_EQ(result.status, 0) << result.errors;
    return result.status == 0;
  }();
  EXPECT_TRUE(made);
  return folder;
}

json document() {
  return json::parse(content(reproduction().file("r/summary.json")));
}

double ours(const std::string& what) {
  const json found = document();
  for (const auto& number : found["numbers"]) {
    if (number["what"] == what) return number["ours"].get<double>();
  }
  ADD_FAILURE() << "no number '" << what << "'";
  return std::nan("");
}

TEST(Reproduce, LeavesEveryFigureAsDataAndTheTableOfNumbers) {
  for (const std::string figure :
       {"figure_07_step_responses", "figure_08_steady_responses", "figure_09_bode",
        "figure_10_simulation", "figure_11_experiment", "figure_12_spectra"}) {
    EXPECT_TRUE(std::filesystem::exists(reproduction().file("r/figures/" + figure + ".csv")))
        << figure;
  }
  EXPECT_THAT(content(reproduction().file("r/reproduction.md")), testing::HasSubstr("31.47"));
  EXPECT_THAT(content(reproduction().file("r/report.html")),
              testing::HasSubstr("numbers of the paper are reproduced within 10 %"));
}

TEST(Reproduce, CleanRecordsOfBothSensorsFitTo99Point5PercentOnHeldOutData) {
  EXPECT_GT(ours("fit, simulated flow sensor"), 99.5);
  EXPECT_GT(ours("fit, simulated whisker sensor"), 99.5);
  EXPECT_GT(ours("fit by SRIVC, simulated flow sensor"), 99.5);
  EXPECT_GT(ours("fit by SRIVC, simulated whisker sensor"), 99.5);
}

TEST(Reproduce, IdentifiesTheBuiltSensorInTheSimulatedExperiment) {
  EXPECT_NEAR(ours("resonance, built flow sensor"), 31.47, 0.1);
  EXPECT_NEAR(ours("damping ratio, built flow sensor"), 0.027, 0.002);
  EXPECT_GT(ours("SDR of BVRM, experiment"), ours("SDR of FDAF, experiment (L = 200, mu = 0.001)"));
}

// 1 / mu blocks are 400 s, more than the record: this filter has hardly begun.
TEST(Reproduce, FindsThatThePapersSettingInTheExperimentRemovesAlmostNothing) {
  const json readings = document()["fdaf_readings"];
  EXPECT_NEAR(readings[0]["learning_time_s"].get<double>(), 400., 1e-9);
  EXPECT_TRUE(readings[0]["convergence_s"].is_null());
  EXPECT_LT(readings[0]["sdr_db"].get<double>(), readings[2]["sdr_db"].get<double>() - 10.);
}

TEST(LongBenchmarkSeparation, ScoresEveryMethodInEveryScenarioAndSaysWhatIsLeftOut) {
  const Folder folder;
  const auto result =
      vibrissa("benchmark separation" + flow_case() + " -o '" + folder.file("b") + "' --json");
  ASSERT_EQ(result.status, 0) << result.errors;
  const json found = result.json();
  EXPECT_GE(found["scenarios"].size(), 12u);
  EXPECT_EQ(found["left_out"].size(), 2u);  // no recordings were given
  for (const auto& scenario : found["scenarios"]) {
    for (const auto& method : scenario["methods"]) {
      EXPECT_TRUE(method["sdr_db"].is_number()) << scenario["name"] << " " << method["name"];
    }
  }
  EXPECT_TRUE(std::filesystem::exists(folder.file("b/figures/separation_suite.csv")));
}

}  // namespace
}  // namespace vibrissa::apps
