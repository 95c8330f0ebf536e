#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

namespace vibrissa::signals {

/// The middle one of the sorted values; of an even number the upper one of both. Values must not be
/// empty. Proven by tests/signals/base/median_test.cc.
inline double median(std::vector<double> values) {
  assert(!values.empty());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Standard deviation of normal values with mean zero, from their magnitudes: 1.4826 times the
/// median. A few outliers do not move it. Proven by tests/signals/base/median_test.cc.
inline double robust_deviation(std::vector<double> magnitudes) {
  constexpr double deviation_over_median = 1.482602;  // 1 / (normal quantile of 0.75)
  return deviation_over_median * median(std::move(magnitudes));
}

}  // namespace vibrissa::signals
