#include "diagnosis/model/joint_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vibrissa::diagnosis {
namespace {

StructuralMode mode() {
  return {.frequency_rad_s = 2. * std::numbers::pi * 37.,
          .damping_ratio = 0.05,
          .base_gain = -8e-6,
          .base_rate = -7.2e-7};
}

constexpr double viscous_ratio = 0.09;

/// Base moment per unit of an additional joint moment T, by the joint model with its factors.
Complex added_moment(const JointModel& model, Complex s) {
  const Complex joint = model.share / model.changed_stiffness_ratio(s);
  const Complex inertia = model.changed_inertia(s) * (joint + 1. - model.share);
  const Complex x = s / model.frequency_rad_s;
  const Complex z =
      model.change.inertia * (x * x + 2. * model.change.rest_damping * model.damping * x);
  return z * joint / (1. + inertia);
}

TEST(JointModel, HasThePoleOfItsMode) {
  const StructuralMode given = mode();
  const JointModel model(given, 0.65, viscous_ratio);
  const double z = given.damping_ratio, w = given.frequency_rad_s;
  const Complex pole = w * Complex(-z, std::sqrt(1. - z * z));
  // Springs and damper in series have the mode's damping to first order in their loss.
  const Complex compliance = model.share / model.stiffness_ratio(pole) + 1. - model.share;
  EXPECT_LT(std::abs(model.inertia(pole) * compliance + 1.), 0.02);
}

TEST(JointModel, AStaticMomentInTheJointDoesNotReachTheBase) {
  EXPECT_LT(std::abs(added_moment(JointModel(mode(), 0.65, viscous_ratio), Complex(0., 1e-6))),
            1e-9);
}

class JointIntegratorTest : public testing::TestWithParam<JointChange> {};

TEST_P(JointIntegratorTest, AnswersASineAsTheTransferFunctionSays) {
  const JointModel model(mode(), 0.65, viscous_ratio, GetParam());
  const double w = 0.8 * model.frequency_rad_s;
  const auto error = [&](double dt) {
    JointIntegrator integrator(model, dt);
    const auto n = static_cast<std::size_t>(std::lround(4. / dt));
    double largest = 0.;
    for (std::size_t i = 1; i <= n; ++i) {
      const double t = static_cast<double>(i) * dt, torque = std::sin(w * t);
      const Lanes moment = integrator.accept(Lanes::Constant(torque), Lanes::Zero()).moment;
      const Complex expected = added_moment(model, Complex(0., w)) * std::exp(Complex(0., w * t));
      if (t > 3.7) largest = std::max(largest, std::abs(moment(0) - expected.imag()));
    }
    return largest;
  };
  const double coarse = error(5e-4), fine = error(2.5e-4);
  EXPECT_LT(fine, 1e-3);
  EXPECT_NEAR(std::log2(coarse / fine), 2., 0.15) << "linear loads over a step err by h^2";
}

INSTANTIATE_TEST_SUITE_P(Changes, JointIntegratorTest,
                         testing::Values(JointChange{}, JointChange{.spring = 1.3},
                                         JointChange{.damper = 0.6}, JointChange{.inertia = 1.2},
                                         JointChange{.rest_damping = 2.}));

}  // namespace
}  // namespace vibrissa::diagnosis
