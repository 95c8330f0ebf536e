#include "separation/ringdown/decay_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vibrissa::separation {
namespace {

constexpr double pi = std::numbers::pi;

TEST(DecayLaw, OfAViscousModeIsADampedSine) {
  const double zeta = 0.05, w = 2. * pi * 30., damped = w * std::sqrt(1. - zeta * zeta);
  const std::vector<double> found = decay({.frequency_hz = 30., .damping_ratio = zeta},
                                          {.moment = 1., .rate = 0., .offset = 0.5}, 500, 1000.);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double t = static_cast<double>(i) / 1000., s = zeta * w;
    const double y = std::exp(-s * t) * (std::cos(damped * t) + s / damped * std::sin(damped * t)),
                 rate = -std::exp(-s * t) * w * w / damped * std::sin(damped * t);
    EXPECT_NEAR(found[i], 0.5 + y + 2. * zeta / w * rate, 1e-5);
  }
}

// Nayfeh and Mook 1979, section 4.1.1: f^2 grows by 3/4 of the cubic term.
TEST(EquivalentMode, OfACubicSpring) {
  const DecayLaw law{.frequency_hz = 30., .damping_ratio = 0.01, .cubic = 0.2};
  const EquivalentMode mode = equivalent_mode(law, 0.5);
  EXPECT_NEAR(mode.frequency_hz, 30. * std::sqrt(1. + 0.75 * 0.2 * 0.25), 1e-6);
}

// The drag takes 8/3 d w^2 A^3 of energy in a cycle.
TEST(EquivalentMode, OfDrag) {
  const EquivalentMode mode =
      equivalent_mode({.frequency_hz = 30., .damping_ratio = 0.01, .drag = 0.03}, 0.5);
  const double of_drag = 4. / (3. * pi) * 0.03 * 0.5;
  EXPECT_NEAR(mode.damping_ratio, 0.01 + of_drag, 1e-5);
  EXPECT_NEAR(mode.drag_share, of_drag / (0.01 + of_drag), 1e-3);
}

// Friction that hardly yields before it slips takes 4 F A in a cycle.
TEST(EquivalentMode, OfCoulombFriction) {
  for (const double reversal : {0., 1.}) {
    const DecayLaw law{.frequency_hz = 30.,
                       .damping_ratio = 0.01,
                       .slip = 0.02,
                       .stick_ratio = 50.,
                       .reversal = reversal};
    const EquivalentMode mode = equivalent_mode(law, 1.);
    EXPECT_NEAR(mode.damping_ratio, 0.01 + 2. / pi * 0.02, 3e-4);
  }
}

TEST(EquivalentMode, OfFrictionThatSticksIsStiff) {
  for (const double reversal : {0., 1.}) {
    const DecayLaw law{.frequency_hz = 30.,
                       .damping_ratio = 0.01,
                       .slip = 0.02,
                       .stick_ratio = 0.21,
                       .reversal = reversal};
    const EquivalentMode mode = equivalent_mode(law, 1e-6);
    EXPECT_NEAR(mode.frequency_hz, 33., 0.01);
    EXPECT_NEAR(mode.friction_share, 0., 1e-3);
  }
}

}  // namespace
}  // namespace vibrissa::separation
