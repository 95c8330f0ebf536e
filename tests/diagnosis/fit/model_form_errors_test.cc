#include "diagnosis/fit/model_form_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

/// One record of ten bins that all lie in one block of frequencies: 0.1 x 35 Hz.
Experiment one_block() {
  Experiment experiment;
  experiment.scales.first_mode_rad_s = 2. * std::numbers::pi * 35.;
  PreparedRecord record;
  record.sampling_rate_hz = 1.;
  record.n_evaluated = 100;
  record.moment.resize(10);
  experiment.records = {record};
  return experiment;
}

HypothesisFit fit_of(const std::vector<const Effect*>& effects, Complex mean,
                     const FormErrors& model_form_errors, double log_likelihood) {
  HypothesisFit fit;
  fit.hypothesis = Hypothesis(effects);
  fit.log_likelihood = log_likelihood;
  fit.records = {{.mean = std::vector<Complex>(10, mean),
                  .process_noise = std::vector<double>(10, 0.),
                  .variance = std::vector<double>(10, 2.),
                  .model_form_errors = model_form_errors}};
  return fit;
}

FormErrors errors(double linear, double nonlinear) {
  return {std::vector<double>(10, linear), std::vector<double>(10, nonlinear)};
}

TEST(HiddenGain, IsWhatFormErrorsExplainLessThePriceOfTheirFreedom) {
  const Effect *hardening = &find_effect("hardening"), *delay = &find_effect("delay");
  const HypothesisFit fewer = fit_of({hardening}, 0., errors(0., 3.), 0.);
  const HypothesisFit more = fit_of({hardening, delay}, Complex(2., 0.), errors(0., 3.), 1e3);
  // g = 4, f = 3, S = 2 in ten bins.
  EXPECT_NEAR(hidden_gain(one_block(), more, fewer), 15. - std::log1p(15.), 1e-12);
}

TEST(HiddenGain, IsNoMoreThanWhatWasGained) {
  const Effect *hardening = &find_effect("hardening"), *delay = &find_effect("delay");
  const HypothesisFit fewer = fit_of({hardening}, 0., errors(0., 300.), 0.);
  const HypothesisFit more = fit_of({hardening, delay}, Complex(20., 0.), errors(0., 300.), 5.);
  EXPECT_NEAR(hidden_gain(one_block(), more, fewer), 5., 1e-12);
}

TEST(HiddenGain, LinearFormErrorsHideLittleAndNothingNonlinear) {
  const Effect *delay = &find_effect("delay"), *lowpass = &find_effect("sensor_lowpass"),
               *backlash = &find_effect("backlash");
  const HypothesisFit fewer = fit_of({delay}, 0., errors(1e3, 0.), 0.);
  const HypothesisFit linear = fit_of({delay, lowpass}, Complex(30., 0.), errors(0., 0.), 1e5);
  const HypothesisFit nonlinear = fit_of({delay, backlash}, Complex(30., 0.), errors(0., 0.), 1e5);
  EXPECT_NEAR(hidden_gain(one_block(), linear, fewer), 40., 1e-12);
  EXPECT_EQ(hidden_gain(one_block(), nonlinear, fewer), 0.);
}

TEST(HiddenGain, ATrueEffectIsNotHiddenByASensorThatIsAsSimulated) {
  test::OneModeRig rig = test::noisy_rig();
  rig.delay_s = 1e-3;
  const Experiment experiment =
      prepare_experiment(test::nominal_of(test::OneModeRig{}, false), test::rig_dataset(rig),
                         signals::Split::fit, InputNoise::reduced);
  const HypothesisFit none = fit_hypothesis(experiment, Hypothesis{});
  const HypothesisFit delay = fit_hypothesis(experiment, Hypothesis({&find_effect("delay")}));
  const double gained = delay.log_likelihood - none.log_likelihood;
  EXPECT_GT(gained, 200.);
  EXPECT_LT(hidden_gain(experiment, delay, none), 0.25 * gained);
}

}  // namespace
}  // namespace vibrissa::diagnosis
