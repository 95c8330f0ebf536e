#include "diagnosis/diagnosis.h"

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "diagnosis/nominal_identification.h"
#include "one_mode_rig.h"
#include "signals/error.h"

namespace vibrissa::diagnosis {
namespace {

using testing::Contains;
using testing::HasSubstr;

Diagnosis diagnosed(const test::OneModeRig& rig, const test::RigDatasetOptions& options = {}) {
  return diagnose(test::nominal_of(test::OneModeRig{}, options.wind),
                  test::rig_dataset(rig, options), {.search = {.max_effects = 1}});
}

TEST(Diagnose, CallsNoneNone) {
  const Diagnosis diagnosis = diagnosed(test::noisy_rig());
  EXPECT_EQ(diagnosis.verdict, "none");
  EXPECT_GT(diagnosis.gap.p_value, 0.01);
  EXPECT_NEAR(diagnosis.gap.nrmse, diagnosis.gap.noise_floor, 0.1 * diagnosis.gap.noise_floor);
}

TEST(Diagnose, NamesASofterWhiskerWithItsSize) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 0.9;
  const Diagnosis diagnosis = diagnosed(rig);
  EXPECT_EQ(diagnosis.verdict, "stiffness");
  EXPECT_THAT(diagnosis.location.links, Contains("structure"));
  ASSERT_FALSE(diagnosis.ranking.front().parameters.empty());
  const ParameterEstimate& ratio = diagnosis.ranking.front().parameters.front();
  EXPECT_EQ(ratio.name, "ratio");
  EXPECT_LT(ratio.ci95[0], 0.9);
  EXPECT_GT(ratio.ci95[1], 0.9);
  ASSERT_TRUE(diagnosis.ranking.front().held_out);
  EXPECT_GT(diagnosis.ranking.front().held_out->overall.gap_closed.value_or(0.), 0.97);
}

TEST(Diagnose, NamesADelayWithItsSize) {
  test::OneModeRig rig = test::noisy_rig();
  rig.delay_s = 1e-3;
  const Diagnosis diagnosis = diagnosed(rig);
  EXPECT_EQ(diagnosis.verdict, "delay");
  EXPECT_EQ(diagnosis.location.links.front(), "clock");
  const ParameterEstimate& tau = diagnosis.ranking.front().parameters.front();
  EXPECT_LT(tau.ci95[0], 1e-3);
  EXPECT_GT(tau.ci95[1], 1e-3);
  EXPECT_GT(diagnosis.ranking.front().held_out->overall.gap_closed.value_or(0.), 0.97);
}

TEST(Diagnose, ProbabilitiesSumToOneAndTheConfidenceSetHolds95Percent) {
  test::OneModeRig rig = test::noisy_rig();
  rig.delay_s = 1.25e-4;
  const Diagnosis diagnosis = diagnosed(rig);
  double sum = diagnosis.probability_of_unlisted;
  for (const RankedAnswer& answer : diagnosis.ranking) sum += answer.probability;
  EXPECT_NEAR(sum, 1., 1e-9);
  EXPECT_EQ(diagnosis.confidence_set.front(), diagnosis.verdict);
}

TEST(Diagnose, RefusesUnitsThatSpoilEverything) {
  signals::Dataset dataset = test::rig_dataset(test::noisy_rig());
  for (signals::DatasetRecord& entry : dataset.records) {
    const auto a = entry.record.channel(signals::channel::base_acceleration);
    std::vector<double> in_g(a.begin(), a.end());
    for (double& v : in_g) v /= 9.80665;
    entry.record.set_channel(signals::channel::base_acceleration, std::move(in_g));
  }
  try {
    diagnose(test::nominal_of(test::OneModeRig{}, false), dataset);
    FAIL();
  } catch (const signals::UserError& error) {
    EXPECT_THAT(error.what(), HasSubstr("9.80665"));
  }
}

TEST(Diagnose, SaysWhatIsMissingWhenNothingCanBeSaid) {
  signals::Dataset dataset = test::rig_dataset(test::noisy_rig(), {.held_out = false});
  dataset.records.erase(dataset.records.begin() + 1, dataset.records.end());  // quiet
  try {
    diagnose(test::nominal_of(test::OneModeRig{}, false), dataset);
    FAIL();
  } catch (const TooPoorData& error) {
    EXPECT_THAT(error.what(), HasSubstr("no fit record"));
  }
}

TEST(ConfidenceSet, IsTheShortestThatReachesTheLevel) {
  const std::vector<Candidate> candidates{
      {.name = "a", .fit = 0, .retunes = {}, .probability = 0.7},
      {.name = "b", .fit = 0, .retunes = {}, .probability = 0.26},
      {.name = "c", .fit = 0, .retunes = {}, .probability = 0.04}};
  EXPECT_THAT(confidence_set(candidates, 0.95), testing::ElementsAre("a", "b"));
  EXPECT_THAT(confidence_set(candidates, 0.5), testing::ElementsAre("a"));
}

/// Cases of a rig that shares nothing with this project, where they lie beside it.
TEST(Practice, CasesAreDiagnosed) {
  namespace fs = std::filesystem;
  const fs::path practice = fs::path(VIBRISSA_SOURCE_DIR) / ".." / "shared" / "practice";
  if (!fs::exists(practice / "labels.json"))
    GTEST_SKIP() << practice << " is missing: put the practice cases there to run this test";
  const auto labels = nlohmann::json::parse(std::ifstream(practice / "labels.json"));
  const NominalModel nominal = identify_nominal(signals::read_dataset(practice / "sim"));
  // The first case of each of two strong linear causes.
  for (const std::string wanted : {"delay", "hum"}) {
    for (const auto& [name, label] : labels.items()) {
      if (label["effect"] != wanted) continue;
      const Diagnosis diagnosis = diagnose(nominal, signals::read_dataset(practice / name / "real"),
                                           {.search = {.max_effects = 1}});
      EXPECT_EQ(diagnosis.verdict, wanted) << name;
      EXPECT_LT(diagnosis.gap.p_value, 0.01) << name;
      break;
    }
  }
}

}  // namespace
}  // namespace vibrissa::diagnosis
