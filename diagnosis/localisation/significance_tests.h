#pragma once

#include <vector>

namespace vibrissa::diagnosis {

/// P(Z > z) of a standard normal; never below 1e-300.
double normal_tail(double z);

/// The standard normal deviate whose tail is that of a ratio of two mean squares; see
/// variance_ratio_tail().
double variance_ratio_deviate(double ratio, double n_over, double n_under);

/// P(F > ratio) for a ratio of two mean squares with n_over and n_under degrees of freedom, by
/// Paulson's (1942) cube-root approximation; the tail is accurate to a few percent for five and
/// more degrees of freedom.
double variance_ratio_tail(double ratio, double n_over, double n_under);

/// p-values with Holm's (1979) step-down correction for multiple tests, in the given order. Proven
/// by tests/diagnosis/localisation/significance_tests_test.cc.
std::vector<double> holm_corrected(const std::vector<double>& p_values);

}  // namespace vibrissa::diagnosis
