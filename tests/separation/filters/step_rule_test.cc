#include "separation/filters/step_rule.h"

#include <gmock/gmock.h>

#include "signals/base/error.h"

namespace vibrissa::separation {
namespace {

using signals::UserError;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(StepRule, IsTheStepOverThePowerOfAStationaryInput) {
  StepRule rule({.step = 0.4, .regularisation = 0.}, 3);
  const Eigen::ArrayXd power = Eigen::Array3d(1., 10., 100.);
  for (int block = 0; block < 5; ++block) rule.update(power);
  const Eigen::ArrayXd step = rule.update(power);
  EXPECT_NEAR(step[0], 0.4, 1e-15);
  EXPECT_NEAR(step[2], 0.004, 1e-15);
}

TEST(StepRule, NeverStepsAboveMuWhenABurstFollowsSilence) {
  StepRule rule({.step = 0.4, .power_forgetting = 0.99, .regularisation = 0.}, 1);
  rule.update(Eigen::ArrayXd::Constant(1, 1e-6));
  EXPECT_NEAR(rule.update(Eigen::ArrayXd::Constant(1, 1e6))[0] * 1e6, 0.4, 1e-12);
}

TEST(StepRule, ForgetsAPowerAtItsRate) {
  StepRule rule({.step = 1., .power_forgetting = 0.9, .regularisation = 0.}, 1);
  rule.update(Eigen::ArrayXd::Constant(1, 100.));
  EXPECT_NEAR(1. / rule.update(Eigen::ArrayXd::Constant(1, 0.))[0], 90., 1e-10);
  EXPECT_NEAR(1. / rule.update(Eigen::ArrayXd::Constant(1, 10.))[0], 82., 1e-10);
}

TEST(StepRule, DividesByTheMeanOrThePresentPowerAlone) {
  StepRule mean({.step = 1.,
                 .smoothing = PowerSmoothing::mean,
                 .power_forgetting = 0.75,
                 .regularisation = 0.},
                1);
  mean.update(Eigen::ArrayXd::Constant(1, 4.));  // P = 1
  EXPECT_NEAR(1. / mean.update(Eigen::ArrayXd::Constant(1, 5.))[0], 2., 1e-12);
  StepRule present({.step = 1., .smoothing = PowerSmoothing::none, .regularisation = 0.}, 1);
  present.update(Eigen::ArrayXd::Constant(1, 100.));
  EXPECT_NEAR(1. / present.update(Eigen::ArrayXd::Constant(1, 3.))[0], 3., 1e-12);
}

TEST(StepRule, HardlyLearnsInBinsWithoutInput) {
  StepRule rule({.step = 1., .regularisation = 0.01}, 2);
  const Eigen::ArrayXd step = rule.update(Eigen::Array2d(2., 0.));
  EXPECT_NEAR(step[0], 1. / 2.01, 1e-12);
  // The floor, not the bin's own power, decides: a thousandth of noise would not be blown up.
  EXPECT_NEAR(step[1], 1. / 0.01, 1e-10);
}

TEST(StepRule, IsZeroInSilenceAndFinitedNearIt) {
  StepRule rule({}, 2);
  EXPECT_EQ(rule.update(Eigen::ArrayXd::Zero(2)).maxCoeff(), 0.);
  EXPECT_TRUE(rule.update(Eigen::ArrayXd::Constant(2, 1e-305)).isFinite().all());
}

TEST(StepRule, LeavesAFixedStepAlone) {
  StepRule rule({.step = 37., .normalisation = StepNormalisation::fixed}, 2);
  EXPECT_EQ(rule.update(Eigen::ArrayXd::Constant(2, 5.))[1], 37.);
}

TEST(StepRule, RefusesOptionsOutOfRange) {
  const auto refuse = [](const StepOptions& options, const std::string& message) {
    EXPECT_THAT([&] { StepRule(options, 2); }, ThrowsMessage<UserError>(HasSubstr(message)));
  };
  refuse({.step = 0.}, "step = 0 must be above 0 and below 2");
  refuse({.step = 2.}, "step = 2 must be above 0 and below 2");
  refuse({.step = -1., .normalisation = StepNormalisation::fixed}, "step = -1 must be positive");
  refuse({.power_forgetting = 1.}, "power_forgetting = 1");
  refuse({.power_forgetting = -0.1}, "power_forgetting = -0.1");
  refuse({.regularisation = -1.}, "regularisation = -1");
}

}  // namespace
}  // namespace vibrissa::separation
