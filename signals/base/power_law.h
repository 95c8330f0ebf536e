#pragma once

#include <span>

namespace vibrissa::signals {

/// Fitted power law |y| = factor x^exponent.
struct PowerLaw {
  double exponent = 0., factor = 0.;
  /// Half of the 95 % interval of the exponent, from the scatter about the straight line. When the
  /// points form a curve, this scatter is not noise; use the local exponents then.
  double half_interval_95 = 0.;
  double lowest_local_exponent = 0., highest_local_exponent = 0.;  // between neighbouring points
};

/// Fits a straight line through ln x, ln |y| by least squares. Throws UserError for fewer than
/// three points, x that are not positive and ascending, and y that are zero or not finite. Proven
/// by tests/signals/base/power_law_test.cc.
PowerLaw fit_power_law(std::span<const double> x, std::span<const double> y);

}  // namespace vibrissa::signals
