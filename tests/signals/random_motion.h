#pragma once

#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

namespace vibrissa::signals::test {

/// A random motion with power up to 180 Hz that is known at every time, and a sensor's response to
/// it: a sum of sines.
class Motion {
 public:
  explicit Motion(const unsigned int seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0., 1.);
    for (int i = 0; i < 100; ++i)
      lines_.push_back({2. * std::numbers::pi * (2. + 178. * uniform(random)),
                        2. * std::numbers::pi * uniform(random)});
  }
  double at(const double t) const {
    return sum(t, [](double) { return std::complex<double>(1.); });
  }
  /// Through a mode at 31 Hz, damping 0.02, elastic moment.
  double moment_at(const double t) const {
    constexpr double w0 = 2. * std::numbers::pi * 31., zeta = 0.02;
    return sum(t, [](const double w) {
      return -1e-4 * w0 * w0 / std::complex<double>(w0 * w0 - w * w, 2. * zeta * w0 * w);
    });
  }

 private:
  struct Line {
    double w, phase;
  };
  template <typename Response>
  double sum(const double t, const Response& response) const {
    double value = 0.;
    for (const Line& line : lines_) {
      const auto h = response(line.w);
      value += std::abs(h) * std::cos(line.w * t + line.phase + std::arg(h));
    }
    return value / std::sqrt(50.);
  }
  std::vector<Line> lines_;
};

/// A device's samples: its clock reads 0 at start_s, and one of its seconds lasts `step`.
template <typename At>
std::vector<double> sampled(const At& at, const double rate_hz, const double start_s,
                            const double step, const double duration_s, std::mt19937& random,
                            const double noise) {
  std::normal_distribution<double> normal(0., noise);
  std::vector<double> values(std::size_t(duration_s * rate_hz));
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = at(start_s + step * double(i) / rate_hz) + normal(random);
  return values;
}

}  // namespace vibrissa::signals::test
