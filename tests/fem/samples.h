#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace vibrissa::fem {

/// Of the records that the transient tests drive a sensor with.
constexpr double rate_hz = 1000.;

/// The largest magnitude of samples.
inline double peak(const std::vector<double>& x) {
  double largest = 0.;
  for (const double value : x) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace vibrissa::fem
