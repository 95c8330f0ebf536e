#pragma once

#include <algorithm>
#include <span>

namespace vibrissa::signals {

/// Whether all values are equal; true for an empty span, false when a value is NaN.
inline bool is_constant(const std::span<const double> x) {
  return std::ranges::all_of(x, [&](const double value) { return value == x.front(); });
}

}  // namespace vibrissa::signals
