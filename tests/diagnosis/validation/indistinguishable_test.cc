#include "diagnosis/validation/named_answers.h"

#include <gmock/gmock.h>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using Sets = std::vector<std::vector<std::string>>;

/// Indistinguishable sets of the first of the given hypotheses, with some calibration effects
/// named.
Sets sets_of(const test::OneModeRig& rig, const std::vector<std::string>& calibrations,
             const std::vector<Hypothesis>& hypotheses) {
  const Experiment experiment =
      prepare_experiment(test::nominal_of(test::OneModeRig{}, false), test::rig_dataset(rig),
                         signals::Split::fit, InputNoise::reduced);
  SearchResult result;
  for (const Hypothesis& hypothesis : hypotheses)
    result.fits.push_back(fit_hypothesis(experiment, hypothesis));
  std::vector<std::string> ids = calibrations;
  for (const Effect* effect : hypotheses.front().effects()) ids.push_back(effect->id);
  result.candidates = {{.name = joined_name(ids), .fit = 0, .calibrations = calibrations}};
  return indistinguishable_sets(experiment, result);
}

Hypothesis only(const std::string& id) {
  return Hypothesis({&find_effect(id)});
}

bool holds(const Sets& sets, const std::string& first, const std::string& other) {
  for (const std::vector<std::string>& set : sets)
    if (set.front() == first && std::find(set.begin(), set.end(), other) != set.end()) return true;
  return false;
}

TEST(Indistinguishable, OneModeCannotTellASofterWhiskerFromASpringInSeriesOrMass) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 0.97;
  const Sets sets = sets_of(rig, {"stiffness"}, {Hypothesis{}});
  EXPECT_TRUE(holds(sets, "stiffness", "base_compliance"));
  EXPECT_TRUE(holds(sets, "stiffness", "mass"));
  EXPECT_FALSE(holds(sets, "stiffness", "delay"));
  EXPECT_FALSE(holds(sets, "stiffness", "hum"));
  EXPECT_FALSE(holds(sets, "stiffness", "hardening"));
}

TEST(Indistinguishable, ATinyDelayIsALowpassButALongOneIsNot) {
  test::OneModeRig rig = test::noisy_rig();
  const std::vector<Hypothesis> alternatives{only("delay"), only("sensor_lowpass"), only("hum")};
  rig.delay_s = 1.25e-4;
  rig.moment_noise = 2e-5;
  EXPECT_TRUE(holds(sets_of(rig, {}, alternatives), "delay", "sensor_lowpass"));
  rig.delay_s = 2e-3;
  EXPECT_TRUE(sets_of(rig, {}, alternatives).empty());
}

TEST(Indistinguishable, AGainOfTheAccelerometerIsThatOfTheSensorWithoutWind) {
  test::OneModeRig rig = test::noisy_rig();
  rig.moment_mass *= 0.98;
  const Sets sets = sets_of(rig, {"reference_gain"},
                            {Hypothesis{}, only("stage_rocking"), only("delay"), only("hum")});
  EXPECT_TRUE(holds(sets, "reference_gain", "sensor_gain"));
  EXPECT_FALSE(holds(sets, "reference_gain", "delay"));
  EXPECT_FALSE(holds(sets, "reference_gain", "hum"));
}

TEST(Indistinguishable, NoneHasNoSets) {
  EXPECT_TRUE(sets_of(test::noisy_rig(), {}, {Hypothesis{}}).empty());
}

}  // namespace
}  // namespace vibrissa::diagnosis
