#include "diagnosis/unknown/unknown_cause.h"

#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <cmath>
#include <numbers>

#include "diagnosis/validation/held_out.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using test::OneModeRig;

constexpr double peak_m = 8e-4;  // about the largest deflection

struct Described {
  UnknownCause cause;
  double peak_m = 0.;  // deflection at the peak moment of the experiment's scales
};

/// Description of a rig's further moment, on records that no fit has seen.
Described described(const std::function<double(double x, double v)>& further,
                    double stiffness = 1.) {
  OneModeRig rig = test::noisy_rig();
  rig.further = further;
  rig.stiffness = stiffness;
  const signals::Dataset dataset = test::rig_dataset(rig);
  const NominalModel nominal = test::nominal_of(OneModeRig{}, false);
  const Experiment experiment =
      prepare_experiment(nominal, dataset, signals::Split::fit, InputNoise::reduced);
  const Experiment unseen =
      prepare_experiment(nominal, dataset, signals::Split::held_out, InputNoise::as_measured);
  const HypothesisFit none = fit_hypothesis(experiment, Hypothesis{});
  const ErrorScore score = score_held_out(experiment, unseen, none, {.n_resamples = 0}).overall;
  const double w = 2. * std::numbers::pi * rig.frequency_hz;
  return {describe_unknown(experiment, unseen, none,
                           std::pow(score.noise_floor / score.nrmse_after, 2)),
          experiment.scales.joint_moment_n_m / (rig.moment_mass * w * w)};
}

TEST(UnknownCause, IsASpringThatIsNotSymmetricWithItsSize) {
  const Described found = described([](double x, double) { return 0.3 * x * x / peak_m; });
  ASSERT_EQ(found.cause.terms.size(), 1u);
  EXPECT_EQ(found.cause.terms[0].name, "angle^2");
  EXPECT_EQ(found.cause.terms[0].place, TermPlace::joint);
  EXPECT_NEAR(found.cause.terms[0].coefficient, 0.3 * found.peak_m / peak_m,
              0.02 * found.peak_m / peak_m);
  EXPECT_GT(found.cause.terms[0].closes, 0.95);
}

TEST(UnknownCause, IsDragOfStillAirAlsoWhereTheStiffnessIsWrong) {
  const Described found =
      described([](double, double v) { return 0.3 * v * std::abs(v) / peak_m; }, 0.92);
  ASSERT_FALSE(found.cause.terms.empty());
  EXPECT_EQ(found.cause.terms[0].name, "rate |rate|");
  EXPECT_GT(found.cause.terms.back().closes, 0.95);
}

TEST(UnknownCause, IsShownAsAMomentOverAngleAndRate) {
  const Described found = described([](double x, double) { return 0.3 * x * x / peak_m; });
  const ResidualCurve& curve = found.cause.residual.over_angle;
  ASSERT_GT(curve.x.size(), 10u);
  // Even in the angle: both ends lie above the middle.
  const double middle = curve.mean[curve.mean.size() / 2];
  EXPECT_GT(curve.mean.front(), middle + 0.05);
  EXPECT_GT(curve.mean.back(), middle + 0.05);
  EXPECT_EQ(found.cause.residual.over_rate.mean.size(), found.cause.residual.over_rate.x.size());
}

TEST(UnknownCause, HasNoTermsWhereNothingIsUnexplained) {
  EXPECT_TRUE(described(nullptr).cause.terms.empty());
}

}  // namespace
}  // namespace vibrissa::diagnosis
