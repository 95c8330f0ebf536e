#include "trial/generator/detection_limit.h"

#include <algorithm>
#include <cmath>

namespace vibrissa::trial {

LikelihoodRatio::LikelihoodRatio(const World& plain, const Session& session,
                                 const Distance distance, const double accuracy)
    : change_(plain, session),
      noise_(change_.noise(plain.moment_noise, plain.acceleration_noise)),
      widened_(unknown_changes(change_, distance, accuracy), noise_) {}

double LikelihoodRatio::noncentrality(const World& world, const bool random) const {
  return widened_.whitened(signature_of(change_of(change_, world, random), noise_)).squaredNorm();
}

std::optional<double> detection_limit(const LikelihoodRatio& test, const Unknown& unknown,
                                      const double sign, const double shape) {
  const auto seen = [&](double size) {
    World world = test.plain();
    unknown.apply(world, sign * size, shape);
    return test.noncentrality(world, unknown.random);
  };
  if (unknown.fixed_size)
    return unknown.largest * std::sqrt(half_power_at_one_percent / seen(unknown.largest));
  double size = unknown.start, power = unknown.random ? 4. : 2.;
  double last_size = 0., last_seen = 0.;
  for (int i = 0; i < 6; ++i) {
    const double now = seen(size);
    if (size == unknown.largest && now < half_power_at_one_percent) return std::nullopt;
    if (std::abs(std::log(now / half_power_at_one_percent)) < 0.2) break;
    if (last_size > 0. && now != last_seen && last_size != size)
      power = std::clamp(std::log(now / last_seen) / std::log(size / last_size), 1., 12.);
    last_size = size;
    last_seen = now;
    const double factor = std::pow(half_power_at_one_percent / std::max(now, 1e-12), 1. / power);
    size = std::min(unknown.largest, size * std::clamp(factor, 0.02, 50.));
  }
  return unknown.hidden_below ? std::max(size, unknown.hidden_below(test.plain())) : size;
}

}  // namespace vibrissa::trial
