#include "diagnosis/diagnosis.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "diagnosis/nominal/nominal_identification.h"
#include "signals/base/error.h"
#include "tests/diagnosis/one_mode_rig.h"

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
  EXPECT_FALSE(ratio.at_limit);
  ASSERT_TRUE(diagnosis.resonance);
  EXPECT_NEAR(diagnosis.resonance->measured_hz / diagnosis.resonance->simulated_hz, std::sqrt(0.9),
              2e-3);
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

TEST(Diagnose, DoubtsACauseThatRecordsItHasNotSeenDoNotConfirm) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 0.9;
  signals::Dataset dataset = test::rig_dataset(rig);
  const auto not_confirmed = Contains(testing::Field(&Finding::kind, FindingKind::not_confirmed));
  const NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
  const DiagnoseOptions options{.search = {.max_effects = 1}};
  EXPECT_THAT(diagnose(nominal, dataset, options).findings, testing::Not(not_confirmed));
  rig.stiffness = 1.1;
  dataset.records.back() = test::rig_dataset(rig).records.back();
  const Diagnosis diagnosis = diagnose(nominal, dataset, options);
  EXPECT_EQ(diagnosis.verdict, outside_catalogue);
  EXPECT_THAT(diagnosis.findings, not_confirmed);
}

TEST(Diagnose, TellsWhatComesNearestWhereNothingKnownExplainsTheGap) {
  test::OneModeRig rig = test::noisy_rig();
  rig.cubic = 1e7;
  const Diagnosis diagnosis =
      diagnose(test::nominal_of(test::OneModeRig{}, false), test::rig_dataset(rig),
               {.search = {.max_effects = 1, .left_out = {"hardening", "backlash"}}});
  EXPECT_EQ(diagnosis.verdict, outside_catalogue);
  ASSERT_TRUE(diagnosis.nearest_known);
  ASSERT_TRUE(diagnosis.nearest_known->held_out);
  EXPECT_TRUE(diagnosis.nearest_known->held_out->overall.gap_closed.has_value());
  EXPECT_EQ(diagnosis.nearest_known->probability, 0.);
  EXPECT_EQ(diagnosis.probability_of_outside, diagnosis.ranking.front().probability);
}

TEST(Diagnose, TellsASofterJointFromASofterSupportByTheRotation) {
  test::OneModeRig rig = test::noisy_rig();
  rig.readout = signals::Readout::rotation;
  rig.stiffness = 0.85;
  const Diagnosis diagnosis = diagnosed(rig);
  EXPECT_EQ(diagnosis.verdict, "stiffness");
  EXPECT_GT(diagnosis.ranking.front().probability, 0.8 * diagnosis.probability_of_tried);
  ASSERT_FALSE(diagnosis.ranking.front().parameters.empty());
  EXPECT_NEAR(diagnosis.ranking.front().parameters.front().value, 0.85, 0.01);
  EXPECT_GT(diagnosis.ranking.front().held_out->overall.gap_closed.value_or(0.), 0.97);
}

TEST(Diagnose, LeavesOutWhatTheBenchDidThatCannotBeSimulatedAndSaysSo) {
  signals::Dataset dataset = test::rig_dataset(test::noisy_rig());
  signals::DatasetRecord heavier = dataset.records[1];
  heavier.name = "heavier";
  heavier.setup = {.added_mass_kg = 1e-4, .added_mass_height_m = 0.15};
  dataset.records.push_back(heavier);
  signals::DatasetRecord clamped = dataset.records[1];
  clamped.name = "clamped";
  clamped.setup = {.stage = signals::Stage::clamped};
  clamped.record.set_channel(signals::channel::base_acceleration,
                             std::vector<double>(clamped.record.n_samples(), 0.));
  dataset.records.push_back(clamped);
  const Diagnosis diagnosis = diagnose(test::nominal_of(test::OneModeRig{}, false), dataset,
                                       {.search = {.max_effects = 1}});
  EXPECT_EQ(diagnosis.verdict, "none");
  std::vector<std::string> left_out;
  for (const Finding& finding : diagnosis.findings)
    if (finding.kind == FindingKind::unsimulated_setup) left_out.push_back(finding.record);
  EXPECT_THAT(left_out, testing::ElementsAre("heavier", "clamped"));
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

TEST(Diagnose, WhatIsLeftHoldsTheOddsOfNoKnownEffect) {
  const Diagnosis diagnosis =
      diagnose(test::nominal_of(test::OneModeRig{}, false), test::rig_dataset(test::noisy_rig()),
               {.search = {.max_effects = 1}});
  EXPECT_GT(diagnosis.probability_of_outside, 0.);
  EXPECT_LT(diagnosis.probability_of_outside, 1. - diagnosis.probability_of_tried);
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
  } catch (const TooLittleData& error) {
    EXPECT_THAT(error.what(), HasSubstr("no fit record"));
  }
}

/// Diagnosis of a rig with another sampling rate than the simulation's records.
Diagnosis diagnosed_at(double rate_hz, double stiffness) {
  static const NominalModel nominal = identify_nominal(test::rig_dataset(test::OneModeRig{}));
  test::OneModeRig rig = test::noisy_rig();
  rig.rate_hz = rate_hz;
  rig.stiffness = stiffness;
  return diagnose(nominal, test::rig_dataset(rig),
                  {.search = {.max_effects = 1}, .simulated_rate_hz = 500.});
}

TEST(Diagnose, IsRightWhereSimulationAndRecordsDifferInTheirRates) {
  for (const double rate_hz : {320., 800.}) {
    const Diagnosis nominal = diagnosed_at(rate_hz, 1.);
    EXPECT_EQ(nominal.verdict, "none") << rate_hz;
    EXPECT_THAT(nominal.findings,
                Contains(testing::Field(&Finding::kind, FindingKind::different_rate)));
    const Diagnosis softer = diagnosed_at(rate_hz, 0.9);
    EXPECT_EQ(softer.verdict, "stiffness") << rate_hz;
    const ParameterEstimate& ratio = softer.ranking.front().parameters.front();
    EXPECT_LT(ratio.ci95[0], 0.9) << rate_hz;
    EXPECT_GT(ratio.ci95[1], 0.9) << rate_hz;
    EXPECT_GT(softer.ranking.front().held_out->overall.gap_closed.value_or(0.), 0.97) << rate_hz;
  }
}

TEST(Diagnose, IsRightWhereRecordsDifferInTheirRates) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 0.9;
  signals::Dataset dataset = test::rig_dataset(rig);
  rig.rate_hz = 800.;
  // Same length, so that they differ only in the sampling rate.
  for (const signals::DatasetRecord& entry : test::rig_dataset(rig, {.seed = 70}).records)
    dataset.records.push_back(entry);
  const Diagnosis diagnosis = diagnose(test::nominal_of(test::OneModeRig{}, false), dataset,
                                       {.search = {.max_effects = 1}});
  EXPECT_EQ(diagnosis.verdict, "stiffness");
  EXPECT_GT(diagnosis.ranking.front().held_out->overall.gap_closed.value_or(0.), 0.97);
}

/// One record of a second that does not repeat, and nothing else.
signals::Dataset one_second(double stiffness, unsigned seed) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = stiffness;
  signals::Dataset dataset =
      test::rig_dataset(rig, {.quiet = false, .held_out = false, .seed = seed});
  dataset.records.erase(dataset.records.begin());
  signals::DatasetRecord& entry = dataset.records.front();
  entry.record = entry.record.slice(0, 500);
  entry.period_samples = 0;
  return dataset;
}

TEST(Diagnose, NamesNothingWrongWithCertaintyFromOneSecond) {
  const NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
  for (const auto& [stiffness, truth] : {std::pair{1., "none"}, std::pair{0.9, "stiffness"}})
    for (unsigned seed = 100; seed < 1100; seed += 100) {
      const Diagnosis diagnosis =
          diagnose(nominal, one_second(stiffness, seed), {.search = {.max_effects = 1}});
      const double wrong = diagnosis.verdict == truth ? 0. : diagnosis.ranking.front().probability;
      EXPECT_LT(wrong, 0.8) << diagnosis.verdict << " " << seed;
      EXPECT_THAT(diagnosis.findings,
                  Contains(testing::Field(&Finding::kind, FindingKind::no_quiet_record)));
      EXPECT_FALSE(diagnosis.location.level_exponent);
      EXPECT_FALSE(diagnosis.ranking.front().held_out);
    }
}

TEST(Diagnose, IsTooPoorFromRecordsThatAreAllTooShort) {
  signals::Dataset dataset = one_second(1., 1);
  dataset.records.front().record = dataset.records.front().record.slice(0, 300);
  try {
    diagnose(test::nominal_of(test::OneModeRig{}, false), dataset);
    FAIL();
  } catch (const TooLittleData& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("base_high: the record is not used: 300 samples are too few"));
  }
}

TEST(Diagnose, LeavesOutAHeldOutRecordThatIsTooShort) {
  signals::Dataset dataset = test::rig_dataset(test::noisy_rig());
  dataset.records.back().record = dataset.records.back().record.slice(0, 300);
  const Diagnosis diagnosis = diagnose(test::nominal_of(test::OneModeRig{}, false), dataset,
                                       {.search = {.max_effects = 1}});
  EXPECT_EQ(diagnosis.verdict, "none");
  EXPECT_THAT(diagnosis.findings, Contains(testing::Field(&Finding::kind, FindingKind::too_short)));
}

TEST(Diagnose, SaysWhatItCouldNotTestWithoutTheWindColumn) {
  signals::Dataset dataset = test::rig_dataset(test::noisy_rig(), {.wind = true});
  for (signals::DatasetRecord& entry : dataset.records) {
    signals::Record record(entry.record.sampling_rate_hz(), entry.record.n_samples());
    for (const std::string& name :
         {signals::channel::base_acceleration, signals::channel::base_moment}) {
      const auto x = entry.record.channel(name);
      record.set_channel(name, {x.begin(), x.end()});
    }
    entry.record = std::move(record);
  }
  const Diagnosis diagnosis =
      diagnose(test::nominal_of(test::OneModeRig{}, true), dataset, {.search = {.max_effects = 1}});
  for (const char* id : {"drag_error", "flow_lag", "relative_drag", "turbulence"}) {
    EXPECT_THAT(
        diagnosis.untested,
        Contains(testing::AllOf(testing::Field(&UntestedEffect::effect, id),
                                testing::Field(&UntestedEffect::reason, HasSubstr("wind")))));
    for (const RankedAnswer& answer : diagnosis.ranking)
      EXPECT_THAT(effect_ids(answer.name), testing::Not(Contains(id)));
  }
  EXPECT_THAT(diagnosis.findings, Contains(testing::Field(&Finding::kind, FindingKind::no_wind)));
}

TEST(Diagnose, DoesNotSayWhichGainIsOffWithoutWind) {
  signals::Dataset dataset = test::rig_dataset(test::noisy_rig());
  for (signals::DatasetRecord& entry : dataset.records) {
    const auto m = entry.record.channel(signals::channel::base_moment);
    std::vector<double> larger(m.begin(), m.end());
    for (double& v : larger) v *= 1.2;
    entry.record.set_channel(signals::channel::base_moment, std::move(larger));
  }
  const Diagnosis diagnosis = diagnose(test::nominal_of(test::OneModeRig{}, false), dataset,
                                       {.search = {.max_effects = 1}});
  ASSERT_TRUE(diagnosis.verdict == "sensor_gain" || diagnosis.verdict == "reference_gain");
  EXPECT_THAT(diagnosis.indistinguishable,
              Contains(testing::UnorderedElementsAre("sensor_gain", "reference_gain")));
  const ParameterEstimate& gain = diagnosis.ranking.front().parameters.front();
  const double whole = gain.effect == "sensor_gain" ? 1.2 : 1. / 1.2;
  EXPECT_LE(gain.ci95[0], std::min(1., whole));
  EXPECT_GE(gain.ci95[1], std::max(1., whole));
  EXPECT_THAT(verdict_text(diagnosis), HasSubstr("(or change "));
}

TEST(Diagnose, DiagnosesWindAlone) {
  test::OneModeRig rig = test::noisy_rig();
  rig.drag *= 1.3;
  signals::Dataset dataset = test::rig_dataset(rig, {.wind = true});
  std::erase_if(dataset.records, [](const auto& entry) { return entry.excitation.base; });
  const Diagnosis diagnosis =
      diagnose(test::nominal_of(test::OneModeRig{}, true), dataset, {.search = {.max_effects = 1}});
  // Without base motion the sensor's gain has the same influence, so either may come first.
  EXPECT_THAT(diagnosis.verdict, testing::AnyOf("drag_error", "sensor_gain"));
  EXPECT_THAT(diagnosis.indistinguishable,
              Contains(testing::UnorderedElementsAre("drag_error", "sensor_gain")));
  EXPECT_THAT(diagnosis.untested,
              Contains(testing::Field(&UntestedEffect::effect, "reference_gain")));
}

TEST(Diagnose, DescribesASpringThatIsInNoCatalogue) {
  test::OneModeRig rig = test::noisy_rig();
  rig.further = [](double x, double) { return 0.3 * x * x / 8e-4; };
  const Diagnosis diagnosis = diagnosed(rig);
  EXPECT_EQ(diagnosis.verdict, outside_catalogue);
  ASSERT_TRUE(diagnosis.unknown_cause);
  ASSERT_FALSE(diagnosis.unknown_cause->terms.empty());
  EXPECT_EQ(diagnosis.unknown_cause->terms.front().name, "angle^2");
  EXPECT_GT(diagnosis.unknown_cause->terms.front().closes, 0.95);
}

/// Cases of an independent rig simulator, if they are available.
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
