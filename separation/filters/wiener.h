#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "signals/record/record.h"

namespace vibrissa::separation {

struct WienerOptions {
  std::size_t filter_length = 440;
  /// Pull of the taps towards zero, as a share of the acceleration's mean square: what few lines
  /// do not determine stays zero.
  double regularisation = 1e-9;
};

struct WienerResult {
  std::vector<double> taps;         // base acceleration to base moment [kg m]
  std::vector<double> wind_moment;  // M_r - taps * a
  /// |gradient| at the end over that at the start; 1e-10 unless the data are too ill-conditioned.
  double relative_gradient = 0.;
  int n_iterations = 0;
};

/// The FIR filter of this length that leaves the least sum of squares of the whole record,
///   minimise sum_i (M_r[i] - sum_k w[k] a[i - k])^2 + n regularisation mean(a^2) |w|^2,
/// a at rest before its first sample: what no causal FIR filter of this length can go below, hence
/// the bound for those that learn it. Conjugate gradients on the normal equations, products by
/// transforms of the record, preconditioned by the circulant nearest to the autocorrelation (T.
/// Chan 1988). It sees the future and the wind that it is tested on: a bound, not a method for
/// streams. Throws UserError for a filter_length of zero or above the number of samples, a negative
/// regularisation, unequal lengths or values that are not finite.
/// Proven by tests/separation/filters/wiener_test.cc against the normal equations.
WienerResult wiener_filter(std::span<const double> base_acceleration,
                           std::span<const double> base_moment, const WienerOptions& options);

/// The same on the channels of a record.
WienerResult wiener_filter(const signals::Record& record, const WienerOptions& options);

}  // namespace vibrissa::separation
