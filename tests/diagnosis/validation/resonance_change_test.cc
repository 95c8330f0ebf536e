#include "diagnosis/validation/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

Experiment bench() {
  return prepare_experiment(test::nominal_of(test::OneModeRig{}, false),
                            test::rig_dataset(test::noisy_rig(), {}), signals::Split::fit,
                            InputNoise::reduced);
}

TEST(ResonanceChange, IsNoneOfTheSimulationItself) {
  const Experiment experiment = bench();
  const auto change = resonance_change(experiment, UpdatedModel(experiment.nominal, {}));
  ASSERT_TRUE(change);
  const double zeta = test::OneModeRig{}.damping_ratio;
  EXPECT_NEAR(change->simulated_hz, 35. * std::sqrt(1. - 2. * zeta * zeta), 0.05);
  EXPECT_EQ(change->measured_hz, change->simulated_hz);
  EXPECT_EQ(change->slow_gain_ratio, 1.);
}

TEST(ResonanceChange, FollowsStiffnessAndGainApart) {
  const Experiment experiment = bench();
  NominalModel softer = experiment.nominal;
  StructuralMode& mode = softer.modes.front();
  mode.frequency_rad_s *= 0.8;
  for (double* gain : {&mode.base_gain, &mode.base_rate}) *gain *= 1.5;
  const auto change = resonance_change(experiment, UpdatedModel(softer, {}));
  ASSERT_TRUE(change);
  EXPECT_NEAR(change->measured_hz / change->simulated_hz, 0.8, 1e-3);
  // At a fifth of the old resonance, a quarter of the new one.
  const double amplified = (1. - 0.2 * 0.2) / (1. - 0.25 * 0.25);
  EXPECT_NEAR(change->slow_gain_ratio, 1.5 * amplified, 0.01);
}

TEST(ResonanceChange, IsNotThereWithoutAModeOrBaseMotion) {
  Experiment experiment = bench();
  const UpdatedModel same(experiment.nominal, {});
  experiment.nominal.modes.clear();
  EXPECT_FALSE(resonance_change(experiment, same));
  Experiment still = bench();
  still.records.clear();
  EXPECT_FALSE(resonance_change(still, same));
}

}  // namespace
}  // namespace vibrissa::diagnosis
