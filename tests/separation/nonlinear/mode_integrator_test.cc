#include "separation/nonlinear/mode_integrator.h"

#include <gtest/gtest.h>

#include <boost/math/special_functions/jacobi_elliptic.hpp>
#include <cmath>
#include <numbers>

#include "tests/signals/rate.h"

namespace vibrissa::separation {
namespace {

using signals::test::rate_hz;

// The free Duffing oscillator: x = A cn(w t, k), w^2 = a0 + c A^2, k^2 = c A^2 / (2 w^2) (Kovacic &
// Brennan, The Duffing Equation, 2011, section 4.2).
TEST(ModeIntegrator, FollowsTheClosedFormOfTheDuffingOscillator) {
  const double a0 = std::pow(2. * std::numbers::pi * 30., 2), amplitude = 1e-3;
  const LawTerm cubic{.kind = LawKind::cubic_stiffness,
                      .coefficient = 0.5 * a0 / (amplitude * amplitude)};
  const ModalTerm mode{.b1 = 0., .b0 = 0., .a1 = 0., .a0 = a0};
  ModeIntegrator integrator(mode, std::span(&cubic, 1), rate_hz, InputPath(Hold::zero_order, 0.),
                            false);
  integrator.start(amplitude, 0.);
  const double w = std::sqrt(1.5 * a0), k = std::sqrt(0.5 * a0 / (2. * w * w));
  double largest = 0.;
  for (int n = 1; n <= 100; ++n) {
    integrator.advance({});
    const double exact = amplitude * boost::math::jacobi_cn(k, w * n / rate_hz);
    largest = std::max(largest, std::abs(integrator.position_m() - exact));
  }
  // 46 rad of the hardened motion, each with a phase error of (1.22 * step_rad)^4 / 120, and as
  // much of its third harmonic.
  EXPECT_LT(largest, 2e-4 * amplitude);
}

TEST(ModeIntegrator, CarriesTheDerivativesOfItsSolution) {
  const std::vector<LawTerm> law{
      {.kind = LawKind::cubic_stiffness, .coefficient = 0.5},
      {.kind = LawKind::quadratic_damping, .coefficient = 0.1},
      {.kind = LawKind::friction, .coefficient = 0.02, .speed_m_s = 0.3}};
  const InputPath path(Hold::first_order, 0.3);
  const auto run = [&](const std::array<double, 7>& p, bool with_sensitivities) {
    std::vector<LawTerm> terms = law;
    for (std::size_t k = 0; k < 3; ++k) terms[k].coefficient = p[2 + k];
    ModeIntegrator integrator({.b1 = 0., .b0 = 0., .a1 = p[0], .a0 = p[1]}, terms, 2., path,
                              with_sensitivities);
    integrator.start(p[5], p[6]);
    for (int n = 0; n < 20; ++n)
      integrator.advance({std::sin(0.5 * n), std::sin(0.5 * (n + 1)), std::sin(0.5 * (n + 2))});
    return integrator;
  };
  const std::array<double, 7> at{0.1, 1., 0.5, 0.1, 0.02, 0.4, -0.2};
  const ModeIntegrator exact = run(at, true);
  constexpr double h = 1e-6;
  for (std::size_t i = 0; i < at.size(); ++i) {
    auto above = at, below = at;
    above[i] += h;
    below[i] -= h;
    const ModeIntegrator more = run(above, false), less = run(below, false);
    const auto j = static_cast<Eigen::Index>(i);
    const auto slope = [](double a, double b) { return (a - b) / (2. * h); };
    EXPECT_NEAR(exact.position_sensitivity()[j], slope(more.position_m(), less.position_m()), 1e-6)
        << i;
    EXPECT_NEAR(exact.velocity_sensitivity()[j], slope(more.velocity_m_s(), less.velocity_m_s()),
                1e-6)
        << i;
    EXPECT_NEAR(exact.law_force_sensitivity()[j], slope(more.law_force(), less.law_force()), 1e-6)
        << i;
  }
}

}  // namespace
}  // namespace vibrissa::separation
