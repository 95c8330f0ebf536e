#include <gtest/gtest.h>

#include "diagnosis/fit/hypothesis_fit.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

/// How much more probable a path from the coil makes the records of a sensor whose second mode, at
/// 300 Hz, the simulation lacks.
double evidence_of_feedthrough(const double residue) {
  test::OneModeRig rig = test::noisy_rig();
  rig.extra_hz = 300.;
  rig.extra_residue = residue;
  const Experiment experiment =
      prepare_experiment(test::nominal_of(test::OneModeRig{}, true),
                         test::rig_dataset(rig, {.wind = false, .quiet = true, .held_out = false}),
                         signals::Split::fit, InputNoise::reduced);
  const HypothesisFit none = fit_hypothesis(experiment, Hypothesis{});
  const Hypothesis path({&find_effect("coil_feedthrough")});
  return fit_hypothesis(experiment, path, &none).log_evidence - none.log_evidence;
}

TEST(ResidualOfHigherModes, IsNoFeedthroughWithinTheAccuracy) {
  EXPECT_LT(evidence_of_feedthrough(0.01), 3.);
}

TEST(ResidualOfHigherModes, HidesNoFeedthroughFarBeyondIt) {
  EXPECT_GT(evidence_of_feedthrough(0.2), 10.);
}

}  // namespace
}  // namespace vibrissa::diagnosis
