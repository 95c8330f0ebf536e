#include "trial/plant/held_motion.h"

#include <gmock/gmock.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "trial/generator/unexplained_change.h"
#include "trial/plant/plant.h"

namespace vibrissa::trial {
namespace {

/// Gain from a sampled sine to the sampled moment, in steady state.
std::complex<double> measured_gain(HeldMotion& motion, const double frequency_hz) {
  constexpr std::size_t n = 4000, settled = 2000;
  const double w = 2. * std::numbers::pi * frequency_hz / rate_hz;
  std::vector<double> a(n);
  for (std::size_t i = 0; i < n; ++i) a[i] = std::cos(w * static_cast<double>(i));
  const std::vector<double> m = motion.base_moment(a, std::vector<double>(n, 0.), 0);
  std::complex<double> sum = 0.;
  for (std::size_t i = settled; i < n; ++i)
    sum += 2. / (n - settled) * m[i] * std::polar(1., -w * static_cast<double>(i));
  return sum;
}

/// The sampled response to an input that is held: the continuous response at the line and its
/// aliases, weighted by the hold (Astrom and Wittenmark 1997, section 2.3); the direct part of the
/// plant acts on the sample itself.
std::complex<double> expected_gain(const StateSpace& plant, const double frequency_hz,
                                   const int order) {
  const double t = 1. / rate_hz, direct = plant.d(output::moment, input::acceleration);
  std::complex<double> sum = direct;
  for (int k = -2000; k <= 2000; ++k) {
    const std::complex<double> s(0., 2. * std::numbers::pi * (frequency_hz + k * rate_hz));
    std::complex<double> weight = (1. - std::exp(-s * t)) / (s * t);
    if (order == 1) weight *= weight * std::exp(s * t);
    sum += (plant.response(s)(output::moment, input::acceleration) - direct) * weight;
  }
  return sum;
}

TEST(HeldMotion, RespondsAsSampledSystemsWithAHoldDo) {
  const Structure& structure = structure_of({});
  const StateSpace plant = make_plant(structure, {});
  HeldMotion constant(structure, {}, Hold::zero_order), linear(structure, {}, Hold::linear);
  for (const double f : {10., 37., 80.}) {
    EXPECT_LT(std::abs(measured_gain(constant, f) / expected_gain(plant, f, 0) - 1.), 1e-3) << f;
    EXPECT_LT(std::abs(measured_gain(linear, f) / expected_gain(plant, f, 1) - 1.), 1e-3) << f;
  }
}

}  // namespace
}  // namespace vibrissa::trial
