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
    JointIntegrator integrator(model.dynamic(), dt);
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

/// Two modes and a spring k between base and whisker, by modal superposition: with e of each mode
/// and the quasi-static rest, y = - (e1 H1 + e2 H2 + rest) T, and M = y + T where nothing is lost.
Complex by_modal_superposition(const Complex s, const double w1, const HigherMode& second,
                               const double first_share) {
  const Complex first = first_share / (s * s / (w1 * w1) + 1.);
  return 1. - first + second.response(s) - (1. - first_share - second.share);
}

JointModel two_modes(const HigherMode& second, const double first_share) {
  StructuralMode first = mode();
  first.damping_ratio = 1e-6;
  JointModel out(first, first_share, 1e-6);
  out.above = {second};
  return out;
}

TEST(JointModel, OfTwoModesIsTheirSuperposition) {
  const HigherMode second{.frequency_rad_s = 900., .damping_ratio = 0.02, .share = 0.2};
  const JointModel model = two_modes(second, 0.7).dynamic();
  for (const double w : {1e-3, 100., 200., 400., 880., 900., 1500., 4000.}) {
    const Complex s(0., w),
        moment = model.changed_stiffness_ratio(s) * model.elastic_response(s).torque + 1.;
    const Complex expected = by_modal_superposition(s, model.frequency_rad_s, second, 0.7);
    EXPECT_LT(std::abs(moment - expected), 0.01 * (std::abs(expected) + 0.01)) << w;
  }
}

TEST(JointIntegrator, MovesTheSecondModeAsTheTransferFunctionSays) {
  const HigherMode second{.frequency_rad_s = 900., .damping_ratio = 0.02, .share = 0.2};
  JointModel given(mode(), 0.7, viscous_ratio);
  given.above = {second};
  const JointModel model = given.dynamic();
  for (const double w : {300., 880.}) {
    const double dt = 1e-4;
    JointIntegrator integrator(model, dt);
    const Complex s(0., w), elastic = model.elastic_response(s).torque,
                            at_base = model.changed_stiffness_ratio(s) * elastic + 1.;
    double largest = 0.;
    for (int i = 1; i <= 20000; ++i) {
      const double t = i * dt;
      const Complex turn = std::polar(1., w * t);
      const Lanes torque = Lanes::Constant(turn.imag());
      const double y = integrator.elastic(torque, Lanes::Zero())(0),
                   rate = integrator.elastic_rate(torque, Lanes::Zero())(0);
      const JointIntegrator::AtBase got = integrator.accept(torque, Lanes::Zero());
      if (i <= 18000) continue;
      largest =
          std::max({largest, std::abs(y - (elastic * turn).imag()), std::abs(got.elastic(0) - y),
                    std::abs(rate / w - (s / w * elastic * turn).imag()),
                    std::abs(got.moment(0) - (at_base * turn).imag())});
    }
    EXPECT_LT(largest, 2e-3 * std::abs(elastic)) << w;
  }
}

}  // namespace
}  // namespace vibrissa::diagnosis
