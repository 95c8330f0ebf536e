#pragma once

#include <span>

namespace vibrissa::separation {

/// Mean of a - b over its standard deviation, which comes from the scatter between 40 pieces of
/// equal length, so that values which depend on their neighbours do not count for more than they
/// are. 0 for no difference at all. Proven by tests/separation/numerics/significance_test.cc.
double mean_difference_significance(std::span<const double> a, std::span<const double> b);

}  // namespace vibrissa::separation
