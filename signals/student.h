#pragma once

namespace vibrissa::signals {

/// Normal quantile of 97.5 %.
inline constexpr double normal_quantile_975 = 1.959964;

/// Student's quantile of 97.5 % by its series in 1 / nu (Abramowitz and Stegun 26.7.5, two terms):
/// within 0.6 % for nu >= 6 degrees of freedom, 4 % low at 3. Proven by
/// tests/signals/power_law_test.cc.
double student_quantile_975(double degrees_of_freedom);

}  // namespace vibrissa::signals
