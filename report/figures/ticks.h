#pragma once

#include <string>
#include <vector>

#include "report/figures/range.h"

namespace vibrissa::report {

/// Tick on an axis; a tick without a label is a minor tick.
struct Tick {
  double at;  // plot coordinate: the value, or its decimal logarithm on a logarithmic axis
  std::string label;

  bool operator==(const Tick&) const = default;
};

struct Ticks {
  std::vector<Tick> marks;
  int exponent = 0;  // labels are multiplied by 10^exponent, which is printed beside the axis
};

/// Round values inside the range at steps of 1, 2 or 5 (in degrees also 15, 30, 45, 90, 180), at
/// most n_most steps. Proven, as the next, by tests/report/figures/ticks_test.cc.
Ticks linear_ticks(const Range& range, int n_most, bool degrees = false);

/// Ticks for decimal logarithms in the range: powers of ten, with their multiples as minor ticks.
/// In short ranges the multiples have labels, too; inside a single step the ticks are linear.
Ticks logarithmic_ticks(const Range& range, int n_most);

/// "10⁻³" with Unicode superscripts.
std::string power_of_ten(int exponent);

}  // namespace vibrissa::report
