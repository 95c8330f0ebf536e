#pragma once

#include <span>

namespace vibrissa::separation {

/// Mean of a - b divided by its standard deviation. The deviation is estimated from the scatter
/// between 40 parts of equal length, so that it is also valid for correlated values. 0 when there
/// is no difference. Proven by tests/separation/numerics/significance_test.cc.
double mean_difference_significance(std::span<const double> a, std::span<const double> b);

}  // namespace vibrissa::separation
