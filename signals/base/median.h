#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
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

}  // namespace vibrissa::signals
