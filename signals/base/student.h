#pragma once

namespace vibrissa::signals {

/// 97.5 % quantile of the normal distribution.
inline constexpr double normal_quantile_975 = 1.959964;

/// 97.5 % quantile of Student's t distribution, for any positive number of degrees of freedom.
/// Proven by tests/signals/base/power_law_test.cc.
double student_quantile_975(double degrees_of_freedom);

}  // namespace vibrissa::signals
