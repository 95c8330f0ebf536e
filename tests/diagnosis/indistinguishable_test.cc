#include "diagnosis/indistinguishable.h"

#include <gmock/gmock.h>

#include "one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using Sets = std::vector<std::vector<std::string>>;

Sets sets_of(const test::OneModeRig& rig, const std::string& name,
             const std::vector<const Effect*>& effects) {
  const Experiment experiment =
      prepare_experiment(test::nominal_of(test::OneModeRig{}, false), test::rig_dataset(rig),
                         signals::Split::fit, InputNoise::reduced);
  const HypothesisFit fit = fit_hypothesis(experiment, Hypothesis(effects));
  return indistinguishable_sets(experiment, fit, {.name = name, .fit = 0, .retunes = {}});
}

bool holds(const Sets& sets, const std::string& first, const std::string& other) {
  for (const std::vector<std::string>& set : sets)
    if (set.front() == first && std::find(set.begin(), set.end(), other) != set.end()) return true;
  return false;
}

TEST(Indistinguishable, OneModeCannotTellASofterWhiskerFromASpringInSeries) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 0.95;
  const Sets sets = sets_of(rig, "stiffness", {});
  EXPECT_TRUE(holds(sets, "stiffness", "base_compliance"));
  EXPECT_FALSE(holds(sets, "stiffness", "delay"));
  EXPECT_FALSE(holds(sets, "stiffness", "hum"));
}

TEST(Indistinguishable, AStrongDelayIsItself) {
  test::OneModeRig rig = test::noisy_rig();
  rig.delay_s = 2e-3;
  const Sets sets = sets_of(rig, "delay", {&find_effect("delay")});
  EXPECT_FALSE(holds(sets, "delay", "stiffness"));
  EXPECT_FALSE(holds(sets, "delay", "hum"));
  EXPECT_FALSE(holds(sets, "delay", "hardening"));
}

TEST(Indistinguishable, AHumIsNotAnythingThatMoves) {
  test::OneModeRig rig = test::noisy_rig();
  rig.hum = 1e-5;
  const Sets sets = sets_of(rig, "hum", {&find_effect("hum")});
  EXPECT_FALSE(holds(sets, "hum", "delay"));
  EXPECT_FALSE(holds(sets, "hum", "sensor_drift"));
}

TEST(Indistinguishable, NoneHasNoSets) {
  EXPECT_TRUE(sets_of(test::noisy_rig(), "none", {}).empty());
}

}  // namespace
}  // namespace vibrissa::diagnosis
