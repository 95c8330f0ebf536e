#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace vibrissa::signals::test {

/// Largest magnitude; 0 of nothing.
inline double peak(std::span<const double> x) {
  double result = 0.;
  for (const double value : x) result = std::max(result, std::abs(value));
  return result;
}

}  // namespace vibrissa::signals::test
