#pragma once

#include <span>

namespace vibrissa::signals {

/// |y| = factor x^exponent, fitted.
struct PowerLaw {
  double exponent = 0., factor = 0.;
  /// Half of the 95 % interval of the exponent, by the scatter about the straight line; where the
  /// points bend away from it that scatter is no noise, and the local exponents tell more.
  double half_interval_95 = 0.;
  double lowest_local_exponent = 0., highest_local_exponent = 0.;  // between neighbours
};

/// Straight line through ln x, ln |y| by least squares. Throws UserError for fewer than three
/// points, x that are not positive and ascending, and y that are zero or not finite.
/// Proven by tests/signals/base/power_law_test.cc.
PowerLaw fit_power_law(std::span<const double> x, std::span<const double> y);

}  // namespace vibrissa::signals
