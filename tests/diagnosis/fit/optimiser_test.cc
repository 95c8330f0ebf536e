#include "diagnosis/fit/optimiser.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "diagnosis/fit/pattern_search.h"
#include "diagnosis/model/hypothesis.h"
#include "diagnosis/records/experiment.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

/// A fit to a rig that is slightly too stiff, started at nominal.
struct Fit {
  Fit() {
    begin.x.resize(static_cast<Eigen::Index>(fit_parameters.size()));
    for (std::size_t i = 0; i < fit_parameters.size(); ++i)
      begin.x(static_cast<Eigen::Index>(i)) = fit_parameters[i].description.prior.centre;
    begin.x(index_of_moment_noise) = std::log(experiment.moment_noise);
    begin.x(index_of_acceleration_noise) = std::log(experiment.acceleration_noise);
    clamp(fit_parameters, begin.x);
    begin.predictions = posterior.predict(begin.x);
    posterior.update_slow_variance(begin.x, begin.predictions);
    begin.log_posterior =
        posterior.log_likelihood(begin.x, begin.predictions) + posterior.log_prior(begin.x);
  }

  static test::OneModeRig stiff_rig() {
    test::OneModeRig rig = test::noisy_rig();
    rig.stiffness = 1.02;
    return rig;
  }

  const Experiment experiment =
      prepare_experiment(test::nominal_of(test::OneModeRig{}, false),
                         test::rig_dataset(stiff_rig()), signals::Split::fit, InputNoise::reduced);
  const Hypothesis hypothesis{{&find_effect("hardening")}};
  const std::vector<FitParameter> fit_parameters = make_fit_parameters(experiment, hypothesis);
  FitPosterior posterior{experiment, fit_parameters, hypothesis};
  OptimiserState begin;
};

/// As near parameters with an unstable joint.
Derivatives no_numbers(Derivatives derivatives) {
  derivatives.mean.setConstant(std::numeric_limits<double>::quiet_NaN());
  return derivatives;
}

TEST(OptimiserState, TakesNoStepThatIsNoNumber) {
  Fit fit;
  OptimiserState plain = fit.begin, misled = fit.begin;
  optimise(fit.posterior, fit.fit_parameters, plain, FitOptions{}.max_iterations, {});
  misled.derivatives = no_numbers(fit.posterior.derivatives(misled.x, misled.predictions));
  optimise(fit.posterior, fit.fit_parameters, misled, FitOptions{}.max_iterations, {});
  ASSERT_TRUE(misled.x.allFinite());
  EXPECT_GT(plain.log_posterior, fit.begin.log_posterior + 10.);
  EXPECT_NEAR(misled.log_posterior, plain.log_posterior, 0.2);
}

/// Fisher scoring in the logarithm of a standard deviation falls by a half at most.
TEST(OptimiserState, FallsFarInOneStepFromANoiseLevelThatIsTooHigh) {
  Fit fit;
  OptimiserState loud = fit.begin;
  loud.x(index_of_moment_noise) += 3.5;
  const double before = loud.x(index_of_moment_noise);
  FitOptions one_step;
  one_step.tolerance = std::numeric_limits<double>::infinity();
  optimise(fit.posterior, fit.fit_parameters, loud, FitOptions{}.max_iterations, one_step);
  EXPECT_LT(loud.x(index_of_moment_noise), before - 1.5);
}

TEST(PatternSearch, FindsTheOptimumWithoutDerivatives) {
  Fit fit;
  Eigen::Index stiffness = 0;
  for (std::size_t i = 0; i < fit.fit_parameters.size(); ++i)
    if (fit.fit_parameters[i].effect != nullptr &&
        fit.fit_parameters[i].effect->id == "stiffness" && fit.fit_parameters[i].parameter == 0)
      stiffness = static_cast<Eigen::Index>(i);
  const Eigen::VectorXd found =
      pattern_search(fit.posterior, fit.fit_parameters, {stiffness}, fit.begin.x);
  const double ratio =
      fit.fit_parameters[static_cast<std::size_t>(stiffness)].description.value(found(stiffness));
  EXPECT_NEAR(ratio, Fit::stiff_rig().stiffness, 0.006);
}

}  // namespace
}  // namespace vibrissa::diagnosis
