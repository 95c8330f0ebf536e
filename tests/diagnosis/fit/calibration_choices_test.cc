#include "diagnosis/fit/calibration_choices.h"

#include <gmock/gmock.h>

#include <cmath>

#include "diagnosis/diagnosis.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

/// Fit of "none" to a rig whose moment sensor has this gain, with vibration and with wind.
HypothesisFit fit_of_gain(const double gain) {
  test::OneModeRig rig = test::noisy_rig();
  rig.moment_mass *= gain;
  const Experiment experiment = prepare_experiment(test::nominal_of(test::OneModeRig{}, true),
                                                   test::rig_dataset(rig, {.wind = true}),
                                                   signals::Split::fit, InputNoise::reduced);
  return fit_hypothesis(experiment, Hypothesis{});
}

double evidence(const HypothesisFit& fit, const std::vector<std::string>& named) {
  for (const CalibrationChoice& choice : fit.choices)
    if (choice.named == named) return choice.log_evidence;
  ADD_FAILURE() << "no such choice";
  return 0.;
}

double ratio(const HypothesisFit& fit, const std::string& name, const std::string& effect) {
  for (const ParameterEstimate& estimate : parameter_estimates(fit, name))
    if (estimate.effect == effect && estimate.name == "ratio") return estimate.value;
  ADD_FAILURE() << "no such estimate";
  return 0.;
}

TEST(CalibrationChoices, OneGainThatIsFarOffIsNamedAloneThoughThreeCouldShareIt) {
  for (const double gain : {1.25, 1.45}) {
    const HypothesisFit fit = fit_of_gain(gain);
    // With tolerances several calibration parameters share the change.
    const auto index = fit.index("sensor_gain", 0);
    ASSERT_TRUE(index.has_value());
    EXPECT_LT(std::exp(fit.x(static_cast<Eigen::Index>(*index))), 1. + 0.8 * (gain - 1.));
    EXPECT_EQ(fit.choices.front().named, std::vector<std::string>{"sensor_gain"});
    EXPECT_GT(evidence(fit, {"sensor_gain"}),
              evidence(fit, {"drag_error", "reference_gain", "sensor_gain"}));
    EXPECT_NEAR(ratio(fit, "sensor_gain", "sensor_gain"), gain, 0.02 * gain);
  }
}

TEST(CalibrationChoices, AGainBeyondItsRangeIsNotNamedAlone) {
  // 1.6 at most.
  const HypothesisFit fit = fit_of_gain(1.9);
  EXPECT_GT(evidence(fit, {"drag_error", "reference_gain", "sensor_gain"}),
            evidence(fit, {"sensor_gain"}));
}

TEST(LogAnyMagnitude, MakesADensityOfADensity) {
  constexpr double top = 0.4, step = 1e-3, least = 1e-9;
  double area = 0.;
  // Equal steps of ln x resolve the peak at zero.
  for (double u = std::log(least * top); u < std::log(top); u += step) {
    const double x = std::exp(u + 0.5 * step);
    area += 2. * x * step * std::exp(log_any_magnitude(top, x, 0.)) / (2. * top);
  }
  EXPECT_NEAR(area, 1., 1e-3);
}

TEST(LogAnyMagnitude, GivesEveryDecadeAsMuch) {
  const auto even = [](double x) { return std::exp(log_any_magnitude(1., x, 0.)) - 0.5; };
  EXPECT_NEAR(even(0.02) * 0.02, even(0.2) * 0.2, 0.05 * even(0.2) * 0.2);
}

TEST(LogAnyMagnitude, OfWhatIsNotToldFromNominalGoesByItsDeviation) {
  EXPECT_NEAR(log_any_magnitude(1., 0., 0.09), log_any_magnitude(1., 0.3, 0.), 1e-12);
}

TEST(RecalibratedPosterior, OfNothingNamedIsTheFit) {
  const HypothesisFit fit = fit_of_gain(1.1);
  const RecalibratedPosterior same = recalibrated_posterior(fit, {});
  EXPECT_EQ(same.log_evidence, fit.log_evidence);
  EXPECT_EQ((same.covariance - fit.covariance).norm(), 0.);
}

}  // namespace
}  // namespace vibrissa::diagnosis
