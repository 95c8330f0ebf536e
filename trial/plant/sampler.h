#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "trial/plant/world.h"

namespace vibrissa::trial {

/// A quantity on the fine clock, which both sensors look at when their own clocks say so.
struct FineSignal {
  std::span<const double> values;
  double rate_hz = 0.;
  double first_s = 0.;  // when the first value is

  /// Cubic between the values; held at the ends.
  double at(double t_s) const;
  /// Mean over what went before: a conversion that takes as long.
  double converted(double t_s, double conversion_s) const;
};

/// When the moment's converter samples: its own rate and delay.
std::vector<double> moment_times(const World& world, double rate_hz, std::size_t n);

/// What the accelerometer says when asked: the last of its own conversions, if it has a clock.
std::vector<double> acceleration_times(const World& world, double rate_hz, std::size_t n,
                                       std::mt19937_64& random);

}  // namespace vibrissa::trial
