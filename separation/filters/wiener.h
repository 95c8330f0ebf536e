#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "signals/record/record.h"

namespace vibrissa::separation {

struct WienerOptions {
  std::size_t filter_length = 440;
  /// Regularisation of the taps towards zero, as a share of the mean square of the acceleration:
  /// taps that an input with few lines does not determine stay zero.
  double regularisation = 1e-9;
};

struct WienerResult {
  std::vector<double> taps;         // base acceleration to base moment [kg m]
  std::vector<double> wind_moment;  // M_r - taps * a
  /// |gradient| at the end divided by |gradient| at the start; 1e-10 unless the data are too
  /// ill-conditioned.
  double relative_gradient = 0.;
  int n_iterations = 0;
};

/// The FIR filter of this length with the smallest sum of squared residuals over the whole record,
///   minimise sum_i (M_r[i] - sum_k w[k] a[i - k])^2 + n regularisation mean(a^2) |w|^2,
/// with a at rest before its first sample. No causal FIR filter of this length has a smaller sum,
/// so it is the bound for the adaptive filters. Conjugate gradients on the normal equations, with
/// products by Fourier transforms and a circulant preconditioner near the autocorrelation (T. Chan
/// 1988). It uses future samples and is scored on its own fit record: it is a bound, not a method
/// for streams. Throws UserError for a filter_length of zero or above the number of samples, a
/// negative regularisation, unequal lengths or values that are not finite. Proven by
/// tests/separation/filters/wiener_test.cc against the normal equations.
WienerResult wiener_filter(std::span<const double> base_acceleration,
                           std::span<const double> base_moment, const WienerOptions& options);

/// The same on the channels of a record.
WienerResult wiener_filter(const signals::Record& record, const WienerOptions& options);

}  // namespace vibrissa::separation
