#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <vector>

#include "signals/files/dataset_response.h"

namespace vibrissa::diagnosis::test {

/// An oscillator y'' = w1^2 (gain a - y) - moment(y, y') in moments [N m], driven by a stepped sine
/// and integrated by the classical Runge-Kutta method: its response is made without the library.
struct SteppedOscillator {
  double frequency_hz = 40., damping_ratio = 0.01, gain = -6e-5;
  /// Addition to the spring's moment [N m] by the moment y and its rate.
  std::function<double(double y, double y_rate)> law = [](double, double) { return 0.; };

  double w1() const { return 2. * std::numbers::pi * frequency_hz; }

  /// Fundamental of the elastic moment at each frequency, in the order of the sweep; the motion
  /// goes on from line to line.
  std::vector<std::complex<double>> swept(const std::vector<double>& frequencies_hz,
                                          const double acceleration_m_s2) const {
    constexpr int steps = 64, settling = 250, measured = 20;
    std::array<double, 2> state{};
    double phase = 0.;
    std::vector<std::complex<double>> out;
    for (const double hz : frequencies_hz) {
      const double h = 1. / (hz * steps), turn = 2. * std::numbers::pi / steps;
      const auto rate = [&](const std::array<double, 2>& x, const double at) {
        return std::array{
            x[1], w1() * w1() * (gain * acceleration_m_s2 * std::cos(at) - x[0] - law(x[0], x[1])) -
                      2. * damping_ratio * w1() * x[1]};
      };
      std::complex<double> sum = 0.;
      for (int i = 0; i < (settling + measured) * steps; ++i) {
        if (i >= settling * steps) sum += state[0] * std::polar(1., -phase);
        const auto moved = [&](const std::array<double, 2>& by, const double share) {
          return std::array{state[0] + share * h * by[0], state[1] + share * h * by[1]};
        };
        const auto k1 = rate(state, phase), k2 = rate(moved(k1, 0.5), phase + 0.5 * turn),
                   k3 = rate(moved(k2, 0.5), phase + 0.5 * turn),
                   k4 = rate(moved(k3, 1.), phase + turn);
        for (std::size_t c = 0; c < 2; ++c)
          state[c] += h / 6. * (k1[c] + 2. * k2[c] + 2. * k3[c] + k4[c]);
        phase = std::remainder(phase + turn, 2. * std::numbers::pi);
      }
      out.push_back(2. * sum / static_cast<double>(measured * steps));
    }
    return out;
  }

  /// The response of the joint's rotation times its stiffness.
  signals::DatasetResponse response(const std::string& name, const std::vector<double>& rising_hz,
                                    const double acceleration_m_s2,
                                    const signals::SweepDirection direction) const {
    signals::DatasetResponse out{.name = name,
                                 .frequency_hz = rising_hz,
                                 .level_m_s2 = std::vector(rising_hz.size(), acceleration_m_s2),
                                 .direction = direction,
                                 .quantity = signals::ResponseQuantity::rotation};
    const bool down = direction == signals::SweepDirection::down;
    std::vector<double> order = rising_hz;
    if (down) std::reverse(order.begin(), order.end());
    out.value = swept(order, acceleration_m_s2);
    if (down) std::reverse(out.value.begin(), out.value.end());
    double peak = 0.;
    for (const auto& value : out.value) peak = std::max(peak, std::abs(value));
    out.standard_deviation.assign(rising_hz.size(), 1e-3 * peak);
    return out;
  }
};

inline std::vector<double> evenly(const double low, const double high, const std::size_t n) {
  std::vector<double> out;
  for (std::size_t i = 0; i < n; ++i)
    out.push_back(std::lerp(low, high, static_cast<double>(i) / static_cast<double>(n - 1)));
  return out;
}

}  // namespace vibrissa::diagnosis::test
