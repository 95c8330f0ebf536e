#include "trial/plant/sampler.h"

#include <algorithm>
#include <cmath>

namespace vibrissa::trial {

double FineSignal::at(const double t_s) const {
  const double place = (t_s - first_s) * rate_hz;
  const double whole = std::floor(place), part = place - whole;
  const auto value = [&](long offset) {
    const long i = static_cast<long>(whole) + offset;
    return values[static_cast<std::size_t>(
        std::clamp(i, 0l, static_cast<long>(values.size()) - 1))];
  };
  const double a = value(-1), b = value(0), c = value(1), d = value(2);
  // Cubic Lagrange interpolation through four neighbours.
  const double x = part;
  return -a * x * (x - 1.) * (x - 2.) / 6. + b * (x + 1.) * (x - 1.) * (x - 2.) / 2. -
         c * (x + 1.) * x * (x - 2.) / 2. + d * (x + 1.) * x * (x - 1.) / 6.;
}

double FineSignal::converted(const double t_s, const double conversion_s) const {
  if (conversion_s <= 0.) return at(t_s);
  const int n = std::max(4, static_cast<int>(std::ceil(conversion_s * rate_hz)));
  double sum = 0.;
  for (int i = 0; i < n; ++i) sum += at(t_s - conversion_s * (i + 0.5) / n);
  return sum / n;
}

std::vector<double> moment_times(const World& world, const double rate_hz, const std::size_t n) {
  std::vector<double> out(n);
  for (std::size_t k = 0; k < n; ++k)
    out[k] = static_cast<double>(k) / rate_hz * (1. + world.rate_error) - world.delay_s;
  return out;
}

std::vector<double> acceleration_times(const World& world, const double rate_hz,
                                       const std::size_t n, std::mt19937_64& random) {
  std::vector<double> out(n);
  const double phase = std::uniform_real_distribution<double>()(random);
  for (std::size_t k = 0; k < n; ++k) {
    const double t = static_cast<double>(k) / rate_hz;
    out[k] = world.read_rate_hz > 0.
                 ? (std::floor(t * world.read_rate_hz + phase) - phase) / world.read_rate_hz
                 : t;
  }
  return out;
}

}  // namespace vibrissa::trial
