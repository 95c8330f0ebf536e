#pragma once

namespace vibrissa::report {

/// From low to high, both included.
struct Range {
  double low, high;

  double length() const { return high - low; }
  bool contains(const double value) const { return value >= low && value <= high; }
  bool operator==(const Range&) const = default;
};

}  // namespace vibrissa::report
