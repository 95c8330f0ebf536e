#include "trial/plant/joint.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace vibrissa::trial {
namespace {

constexpr double k = 0.07, step_s = 1. / 8000.;

/// Work over one cycle of the given amplitude, after two cycles of settling.
double work_of_a_cycle(const JointWorld& world, double height, double hz) {
  Joint joint(world, k, step_s);
  const double w = 2. * std::numbers::pi * hz;
  const auto n = static_cast<int>(std::lround(1. / (hz * step_s)));
  double work = 0., last = 0.;
  for (int i = 1; i <= 3 * n; ++i) {
    const double t = i * step_s, phi = height * std::sin(w * t),
                 rate = height * w * std::cos(w * t);
    const double moment = joint.moment(phi, rate, 0.);
    if (i > 2 * n) work += moment * (phi - last);
    joint.advance(phi);
    last = phi;
  }
  return work;
}

TEST(TrialJoint, IsNothingBeyondItsSpringWhenNeutral) {
  const Joint joint({}, k, step_s);
  EXPECT_EQ(joint.moment(0.01, 1., 5.), 0.);
}

TEST(TrialJoint, StiffeningIsCubicWhereItIsSmall) {
  const Joint joint({.stiffening = 0.1, .scale = 0.01}, k, step_s);
  EXPECT_NEAR(joint.moment(0.002, 0., 0.) / (k * 0.1 * 0.002 * 0.04), 1., 0.01);
  EXPECT_EQ(joint.moment(-0.002, 0., 0.), -joint.moment(0.002, 0., 0.));
}

TEST(TrialJoint, FrictionLosesFourTimesSlipMomentTimesHeightWhenItSlips) {
  const JointWorld world{.friction_moment = 1e-5, .friction_stiffness = 0.5};
  const double height = 0.05;
  EXPECT_NEAR(work_of_a_cycle(world, height, 5.) / (4. * 1e-5 * height), 1., 0.05);
  // Far below the slip moment there is hardly any loss.
  EXPECT_LT(work_of_a_cycle(world, 1e-5, 5.) / (k * 1e-10), 0.02);
}

TEST(TrialJoint, RelaxingBranchesLoseEnergyAndStandForNothingAtRest) {
  const JointWorld world{.branches = 0.2};
  EXPECT_GT(work_of_a_cycle(world, 0.01, 5.), 0.);
  Joint joint(world, k, step_s);
  for (int i = 0; i < 400000; ++i) joint.advance(0.01);
  EXPECT_NEAR(joint.moment(0.01, 0., 0.) / (k * 0.01), 0., 1e-6);
}

TEST(TrialJoint, SofteningRemembersTheHighestStrain) {
  Joint joint({.softening = 0.2, .scale = 0.01}, k, step_s);
  const double before = joint.moment(0.001, 0., 0.);
  joint.advance(0.03);
  EXPECT_EQ(before, 0.);
  EXPECT_NEAR(joint.moment(0.001, 0., 0.), -0.2 * (1. - std::exp(-3.)) * k * 0.001, 1e-9);
}

TEST(TrialJoint, ADeadZoneTakesTheSpringAway) {
  const Joint joint({.dead_zone = 1e-3}, k, step_s);
  EXPECT_NEAR(joint.moment(5e-4, 0., 0.), -k * 5e-4, 1e-15);
  EXPECT_NEAR(joint.moment(5e-3, 0., 0.), -k * 1e-3, 1e-15);
}

}  // namespace
}  // namespace vibrissa::trial
