#pragma once

#include <algorithm>
#include <span>

namespace vibrissa::signals {

/// Whether all values are the same; true for none, false where one is not a number.
inline bool is_constant(const std::span<const double> x) {
  return std::ranges::all_of(x, [&](const double value) { return value == x.front(); });
}

}  // namespace vibrissa::signals
