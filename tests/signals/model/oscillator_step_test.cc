#include "signals/model/oscillator_step.h"

#include <gmock/gmock.h>

#include <complex>

namespace vibrissa::signals {
namespace {

// Answers at time 1 of r'' + 2 zeta x r' + x^2 r to an impulse, a step and a ramp from the poles,
// in long double: sum over the two poles of the divided differences.
struct ClosedForm {
  long double impulse, impulse_slope, step, ramp;
};

ClosedForm closed_form(long double x, long double zeta) {
  using Complex = std::complex<long double>;
  const Complex root = std::sqrt(Complex(zeta * zeta - 1.L));
  const Complex first = x * (-zeta + root), second = x * (-zeta - root);
  const auto difference = [&](auto&& f) {
    return ((f(first) - f(second)) / (first - second)).real();
  };
  return {.impulse = difference([](Complex p) { return std::exp(p); }),
          .impulse_slope = difference([](Complex p) { return p * std::exp(p); }),
          .step = difference([](Complex p) { return (std::exp(p) - 1.L) / p; }),
          .ramp = difference([](Complex p) { return (std::exp(p) - 1.L - p) / (p * p); })};
}

void expect_equals_closed_form(double angle, double zeta, double tolerance) {
  SCOPED_TRACE(testing::Message() << "angle " << angle << ", zeta " << zeta);
  const auto step = make_oscillator_step(angle, zeta);
  const auto wanted = closed_form(angle, zeta);
  const long double x2 = static_cast<long double>(angle) * angle;
  EXPECT_NEAR(step.qq, static_cast<double>(-x2 * wanted.step), tolerance);
  EXPECT_NEAR(step.qp, static_cast<double>(wanted.impulse), tolerance);
  EXPECT_NEAR(step.pq, static_cast<double>(-x2 * wanted.impulse), tolerance * std::max(1., angle));
  EXPECT_NEAR(step.pp, static_cast<double>(wanted.impulse_slope - 1.L), tolerance);
  EXPECT_NEAR(step.q_old, static_cast<double>(wanted.step - wanted.ramp), tolerance);
  EXPECT_NEAR(step.q_new, static_cast<double>(wanted.ramp), tolerance);
  EXPECT_NEAR(step.p_old, static_cast<double>(wanted.impulse - wanted.step), tolerance);
  EXPECT_NEAR(step.p_new, static_cast<double>(wanted.step), tolerance);
  EXPECT_DOUBLE_EQ(step.stiffness, angle * angle);
  EXPECT_DOUBLE_EQ(step.damping, 2. * zeta * angle);
}

TEST(OscillatorStep, EqualsTheClosedFormForEveryDampingAndStep) {
  for (const double angle : {0.05, 0.2, 0.9, 1., 1.1, 3., 7., 20.})
    for (const double zeta : {0., 0.027, 0.5, 0.99, 1.01, 2., 10.})
      expect_equals_closed_form(angle, zeta, 2e-15 * std::max(1., 4. * angle * std::max(1., zeta)));
}

// Critical damping has the double pole -x: e^-x, x e^-x, and their integrals.
TEST(OscillatorStep, EqualsTheClosedFormAtCriticalDamping) {
  for (const double x : {0.3, 1., 4.}) {
    const auto step = make_oscillator_step(x, 1.);
    EXPECT_NEAR(1. + step.qq, (1. + x) * std::exp(-x), 1e-15);
    EXPECT_NEAR(step.qp, std::exp(-x), 1e-15);
    EXPECT_NEAR(1. + step.pp, (1. - x) * std::exp(-x), 4e-15);
    EXPECT_NEAR(step.p_new, (1. - (1. + x) * std::exp(-x)) / (x * x), 4e-15);
    EXPECT_NEAR(step.q_new, (x - 2. + (x + 2.) * std::exp(-x)) / (x * x * x), 4e-14);
  }
}

// Taylor series in the angle x: step = 1/2 - zeta x / 3 + ..., ramp = 1/6 - zeta x / 12 + ...
TEST(OscillatorStep, KeepsAllDigitsForSmallSteps) {
  for (const double x : {1e-9, 1e-7, 1e-5}) {
    const auto step = make_oscillator_step(x, 0.05);
    const double second_order = x * x;
    EXPECT_NEAR(step.p_new, 0.5 - 0.05 * x / 3., 1e-15 + second_order);
    EXPECT_NEAR(step.q_new, 1. / 6. - 0.05 * x / 12., 1e-15 + second_order);
    EXPECT_NEAR(step.q_old, 1. / 3. - 0.05 * x / 4., 1e-15 + second_order);
    EXPECT_NEAR(step.pq / second_order, -1., 0.1 * x + 1e-15 + second_order);
    EXPECT_NEAR(step.qq / second_order, -0.5, 0.1 * x + 1e-15 + second_order);
    EXPECT_NEAR(step.pp / (0.1 * x), -1., 10. * x);
  }
}

TEST(OscillatorStep, StaysStableForVeryStiffAndVeryDampedModes) {
  for (const double angle : {1e2, 1e4})
    for (const double zeta : {0., 1e-3, 1., 30., 1e3}) {
      const auto step = make_oscillator_step(angle, zeta);
      const double qq = 1. + step.qq, pp = 1. + step.pp;
      const double determinant = qq * pp - step.qp * step.pq;
      EXPECT_NEAR(determinant, std::exp(-2. * zeta * angle), 1e-10 * angle * std::max(1., zeta));
      EXPECT_LE(std::abs(qq + pp), 2.0001);
    }
}

}  // namespace
}  // namespace vibrissa::signals
