#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "trial/plant/world.h"

namespace vibrissa::trial {

/// A signal on the fine time grid, which both sensors sample at the times of their own clocks.
struct FineSignal {
  std::span<const double> values;
  double rate_hz = 0.;
  double first_s = 0.;  // time of the first value

  /// Cubic interpolation; constant beyond the ends.
  double at(double t_s) const;
  /// Mean over the preceding interval: a conversion of this duration.
  double converted(double t_s, double conversion_s) const;
};

/// Sampling times of the moment's converter, with its own rate and delay.
std::vector<double> moment_times(const World& world, double rate_hz, std::size_t n);

/// Reading of the accelerometer at the given times: the last of its own conversions, if it has a
/// clock.
std::vector<double> acceleration_times(const World& world, double rate_hz, std::size_t n,
                                       std::mt19937_64& random);

}  // namespace vibrissa::trial
