#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "separation/model/rational_model.h"
#include "tests/signals/rate.h"
#include "tests/signals/white_noise.h"

namespace vibrissa::separation::test {

using Signal = std::vector<double>;
using signals::test::rate_hz;

inline Signal white_noise(std::size_t n, double deviation, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  return signals::test::white_noise(n, deviation, random);
}

/// Lines spread over [low, high] with random phases, at any time.
struct Lines {
  Lines(double low_hz, double high_hz, std::size_t n_lines, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> phase_of(0., 2. * std::numbers::pi);
    for (std::size_t i = 0; i < n_lines; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(n_lines - 1);
      frequency_hz.push_back(low_hz + share * (high_hz - low_hz));
      phase.push_back(phase_of(random));
    }
  }

  Signal sample(std::size_t n, double rate_hz, double delay_s = 0.) const {
    Signal x(n, 0.);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < phase.size(); ++k)
        x[i] += std::cos(2. * std::numbers::pi * frequency_hz[k] *
                             (static_cast<double>(i) / rate_hz - delay_s) +
                         phase[k]);
    return x;
  }

  /// Steady-state answer of a model to these lines.
  Signal answer(const Bvrm& model, std::size_t n, double rate_hz) const {
    const auto g = response(model, frequency_hz);
    Signal y(n, 0.);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < phase.size(); ++k)
        y[i] += std::abs(g[k]) * std::cos(2. * std::numbers::pi * frequency_hz[k] *
                                              static_cast<double>(i) / rate_hz +
                                          phase[k] + std::arg(g[k]));
    return y;
  }

  std::vector<double> frequency_hz, phase;
};

inline double rms(std::span<const double> x) {
  double sum = 0.;
  for (const double value : x) sum += value * value;
  return std::sqrt(sum / static_cast<double>(x.size()));
}

inline Signal minus(std::span<const double> x, std::span<const double> y) {
  Signal difference(x.begin(), x.end());
  for (std::size_t i = 0; i < y.size(); ++i) difference[i] -= y[i];
  return difference;
}

inline Signal plus_noise(Signal x, double deviation, std::uint64_t seed) {
  const Signal noise = white_noise(x.size(), deviation, seed);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += noise[i];
  return x;
}

/// The built flow sensor of the reference study, and with it a second and a third mode.
inline Bvrm sensor(std::size_t n_modes, double direct_term = 0.) {
  Bvrm model;
  if (n_modes > 0) model.modes.push_back(make_modal_term(31.47, 0.027, -9e-6, -2e-9));
  if (n_modes > 1) model.modes.push_back(make_modal_term(172., 0.02, -8e-7, 3e-10));
  if (n_modes > 2) model.modes.push_back(make_modal_term(95., 0.04, -5e-7));
  model.direct_term_kg_m = direct_term;
  return model;
}

}  // namespace vibrissa::separation::test
