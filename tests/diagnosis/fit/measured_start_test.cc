#include "diagnosis/fit/measured_start.h"

#include <gtest/gtest.h>

#include "diagnosis/model/hypothesis.h"

namespace vibrissa::diagnosis {
namespace {

StructuralMode mode(const double frequency_rad_s, const double damping_ratio) {
  return {.frequency_rad_s = frequency_rad_s, .damping_ratio = damping_ratio, .base_gain = 1.};
}

Experiment with_two_modes() {
  Experiment out;
  out.nominal.modes = {mode(100., 0.05), mode(600., 0.02)};
  out.moment_noise = out.acceleration_noise = 1.;
  out.has_base = true;
  return out;
}

Eigen::VectorXd centre(const std::vector<FitParameter>& fit_parameters) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(fit_parameters.size()));
  for (std::size_t i = 0; i < fit_parameters.size(); ++i)
    x(static_cast<Eigen::Index>(i)) = fit_parameters[i].description.prior.centre;
  return x;
}

TEST(StartAtMeasuredModes, MovesEachModeByStiffnessAndDamping) {
  Experiment experiment = with_two_modes();
  // A mode that the simulation does not have is passed over.
  experiment.measured_modes = {mode(90., 0.06), mode(250., 0.1), mode(570., 0.015)};
  const std::vector<FitParameter> parameters = make_fit_parameters(experiment, {});
  const auto x = start_at_measured_modes(experiment, parameters, "stiffness", centre(parameters));
  ASSERT_TRUE(x);
  const Chain chain = make_chain(experiment, parameters, *x);
  ASSERT_EQ(chain.structure.modes.size(), 2u);
  EXPECT_NEAR(chain.structure.modes[0].frequency_rad_s, 90., 1e-6);
  EXPECT_NEAR(chain.structure.modes[1].frequency_rad_s, 570., 1e-6);
  EXPECT_NEAR(chain.structure.modes[0].damping_ratio, 0.06, 1e-6);
}

TEST(StartAtMeasuredModes, ByMassWhereItIsTheHypothesis) {
  Experiment experiment = with_two_modes();
  experiment.measured_modes = {mode(95., 0.05), mode(590., 0.02)};
  const Hypothesis heavier({&find_effect("mass")});
  const std::vector<FitParameter> parameters = make_fit_parameters(experiment, heavier);
  const auto x = start_at_measured_modes(experiment, parameters, "mass", centre(parameters));
  ASSERT_TRUE(x);
  const Chain chain = make_chain(experiment, parameters, *x);
  EXPECT_NEAR(chain.structure.modes[0].frequency_rad_s, 95., 1e-6);
  EXPECT_NEAR(chain.structure.modes[1].frequency_rad_s, 590., 1e-6);
}

TEST(StartAtMeasuredModes, NothingWithoutMeasuredModes) {
  const Experiment experiment = with_two_modes();
  const std::vector<FitParameter> parameters = make_fit_parameters(experiment, {});
  EXPECT_FALSE(start_at_measured_modes(experiment, parameters, "stiffness", centre(parameters)));
}

}  // namespace
}  // namespace vibrissa::diagnosis
