#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "separation/model/fitted_bvrm.h"

namespace vibrissa::separation {

/// Poles s of the continuous process with these covariances, in rad/s, for every order 2, 4, ...
/// max_order: entry k of the answer belongs to order 2 (k + 1). covariances: at the lags 1, 2, ...
/// (2 m - 1) samples, max_order < m; the lag 0, which holds the noise of the sensor, is not used.
/// With the Hankel matrix H[i][j] = R(i + j + 1) = O C, whose factor O spans the powers of the
/// sampled poles, the poles are the eigenvalues of A in O without its last row times A = O without
/// its first (covariance-driven stochastic subspace identification; Van Overschee & De Moor 1996,
/// chapter 3; Peeters & De Roeck 1999). Only poles with positive imaginary part are given.
std::vector<std::vector<std::complex<double>>> covariance_poles(std::span<const double> covariances,
                                                                std::size_t max_order,
                                                                double sampling_rate_hz);

struct OutputOnlyOptions {
  std::size_t max_order = 20;  // orders 2, 4, ... are tried, as far as the record allows
  /// Rows of the Hankel matrix, as far as the record allows: lags up to twice as many samples
  /// are used. They should span a few periods of the lowest resonance; more only add noise.
  std::size_t max_lags = 40;
};

/// A resonance that stands while the order rises.
struct OutputOnlyMode {
  Estimate frequency_hz, damping_ratio;
  std::size_t n_orders = 0;  // of those tried, in which it stands
};

struct OutputOnlyIdentification {
  std::vector<OutputOnlyMode> modes;  // ascending frequency
  /// Sharp, but not shown to decay: a line of the drive, or a mode whose damping the record does
  /// not determine.
  std::vector<Estimate> undamped_hz;
  std::size_t n_orders = 0;  // tried
  std::string words;         // what was found, and what such a record cannot tell
};

/// Resonances and damping from the moment alone, for a sensor driven by something that nobody
/// measured and that is taken for white. Offset and straight drift are taken off. A pole stands
/// when it moves by less than half its decay rate from one order to the next, over a third of
/// the orders; its estimate is the median over them. Deviations: jackknife over 20 pieces of the
/// record. A mode is given when both its deviations are below half its own width, zeta f and zeta,
/// and the lags span a period of it.
/// Gain and direct term cannot be known, and a colour of the drive looks like structure. Throws
/// UserError for fewer than 400 samples, a constant record, a value that is not finite, an odd
/// order. Proven by tests/separation/identification/output_only_test.cc: exact covariances, the
/// Cramer-Rao bound, coverage, white noise without any mode, a line.
OutputOnlyIdentification identify_output_only(std::span<const double> moment,
                                              double sampling_rate_hz,
                                              const OutputOnlyOptions& options = {});

}  // namespace vibrissa::separation
