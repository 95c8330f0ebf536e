#pragma once

namespace vibrissa::signals {

/// Normal quantile of 97.5 %.
inline constexpr double normal_quantile_975 = 1.959964;

/// Student's quantile of 97.5 %, of any positive number of degrees of freedom. Proven by
/// tests/signals/base/power_law_test.cc.
double student_quantile_975(double degrees_of_freedom);

}  // namespace vibrissa::signals
