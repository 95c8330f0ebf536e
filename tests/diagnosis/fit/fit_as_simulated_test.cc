#include <gmock/gmock.h>

#include "diagnosis/fit/hypothesis_fit.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

Experiment experiment_of(const test::OneModeRig& rig) {
  return prepare_experiment(test::nominal_of(test::OneModeRig{}, false), test::rig_dataset(rig),
                            signals::Split::fit, InputNoise::reduced);
}

struct BothFits {
  HypothesisFit free, as_simulated;
};

BothFits both_fits(const Experiment& experiment, const Hypothesis& hypothesis) {
  HypothesisFit free = fit_hypothesis(experiment, hypothesis);
  HypothesisFit as_simulated = fit_as_simulated(experiment, free);
  return {std::move(free), std::move(as_simulated)};
}

double value_of(const HypothesisFit& fit, const std::string& effect) {
  const std::size_t index = fit.index(effect, 0).value();
  return fit.fit_parameters[index].description.value(fit.x(static_cast<Eigen::Index>(index)));
}

const Hypothesis soft_base({&find_effect("base_compliance")});

/// A calibration parameter has the same influence: when it is free, the base seems stiff.
TEST(FitAsSimulated, FindsWhatFreeCalibrationsTakeUp) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 0.99;
  const Experiment experiment = experiment_of(rig);
  const BothFits fits = both_fits(experiment, soft_base);
  EXPECT_GT(value_of(fits.free, "base_compliance"), 200.);
  // 1 / 0.99 = 1 + 1 / 99.
  EXPECT_NEAR(value_of(fits.as_simulated, "base_compliance"), 99., 15.);
  EXPECT_NEAR(fits.as_simulated.x(fits.as_simulated.index("stiffness", 0).value()), 0., 3e-4);
  const HypothesisFit none = both_fits(experiment, {}).as_simulated;
  EXPECT_GT(fits.as_simulated.log_evidence, none.log_evidence + 20.);
}

/// A compliant base cannot stiffen a whisker, whatever a quadratic approximation about a
/// recalibrated one predicts.
TEST(FitAsSimulated, PromisesNothingThatTheEffectCannotDo) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 1.01;
  const Experiment experiment = experiment_of(rig);
  const BothFits none = both_fits(experiment, {}), soft = both_fits(experiment, soft_base);
  EXPECT_LT(soft.as_simulated.log_evidence, none.as_simulated.log_evidence + 2.);
  // Neither fit has a calibration parameter that replaces the effect.
  for (const BothFits& fits : {none, soft})
    EXPECT_LT(fits.as_simulated.log_likelihood, fits.free.log_likelihood - 20.)
        << fits.free.hypothesis.name();
}

TEST(FitAsSimulated, NamesNoCalibration) {
  const BothFits fits = both_fits(experiment_of(test::noisy_rig()), {});
  ASSERT_EQ(fits.as_simulated.choices.size(), 1u);
  EXPECT_TRUE(fits.as_simulated.choices.front().named.empty());
  // Half of all sensors are as simulated.
  EXPECT_NEAR(fits.as_simulated.choices.front().log_evidence,
              fits.as_simulated.log_evidence - std::numbers::ln2, 1e-9);
}

}  // namespace
}  // namespace vibrissa::diagnosis
