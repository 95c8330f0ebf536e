#pragma once

#include <complex>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "separation/model/fitted_bvrm.h"

namespace vibrissa::separation {

/// Poles s of the continuous process with these covariances, in rad/s, for every order 2, 4, ...
/// max_order: entry k of the result belongs to order 2 (k + 1). covariances: at the lags 1, 2, ...
/// (2 m - 1) samples, max_order < m; the lag 0, which contains the noise of the sensor, is not
/// used. With the Hankel matrix H[i][j] = R(i + j + 1) = O C, whose factor O spans the powers of
/// the sampled poles, the poles are the eigenvalues of A in O without its last row times A = O
/// without its first (covariance-driven stochastic subspace identification; Van Overschee & De Moor
/// 1996, chapter 3; Peeters & De Roeck 1999). Only poles with positive imaginary part are given.
std::vector<std::vector<std::complex<double>>> covariance_poles(std::span<const double> covariances,
                                                                std::size_t max_order,
                                                                double sampling_rate_hz);

struct OutputOnlyOptions {
  std::size_t max_order = 20;  // of a mode; orders 2, 4, ... as far as the record allows
  /// Rows of the Hankel matrix, as far as the record allows: lags up to twice as many samples
  /// are used. They should span a few periods of the lowest resonance; more only add noise.
  /// Nothing: lags from the data, see identify_output_only().
  std::optional<std::size_t> max_lags = std::nullopt;
};

/// A resonance whose pole is stable over the orders.
struct OutputOnlyMode {
  Estimate frequency_hz, damping_ratio;
  std::size_t n_orders = 0;  // number of orders in which the pole is stable
};

struct OutputOnlyIdentification {
  std::vector<OutputOnlyMode> modes;  // ascending frequency
  /// Undamped lines: a line of the excitation, or a mode whose damping the record does not
  /// determine.
  std::vector<Estimate> undamped_hz;
  std::size_t n_orders = 0;  // number of tried orders
  std::string words;         // result and limits, as text
};

/// Resonances and damping from the moment alone, under an unmeasured excitation that is assumed
/// white. Offset and linear drift are removed. A pole is stable when it moves by less than half its
/// decay rate from one order to the next, over a third of the orders and at least three, the first
/// of which is at most max_order; its estimate is the median over these orders. Deviations:
/// jackknife over 20 parts of the record. A mode is returned when its deviations are below half of
/// zeta f and half of zeta, and the lags span one of its periods. Without max_lags the record is
/// also taken at the rate divided by 2, 4, 8, ..., as far as it is long enough, each with 40 rows:
/// a resonance is looked for where the lags span 8 to 16 of its periods (the highest octaves: at
/// the full rate, the lowest: at the lowest), and one that decays by less than a factor e within
/// them where they span twice as many, if its damping is better determined there. Gain and direct
/// term cannot be identified, and a coloured excitation looks like a resonance of the structure.
/// Throws UserError for fewer than 400 samples, a constant record, a value that is not finite, an
/// odd order. Proven by tests/separation/identification/output_only_test.cc: exact covariances, the
/// Cramer-Rao bound, coverage, white noise without any mode, a line.
OutputOnlyIdentification identify_output_only(std::span<const double> moment,
                                              double sampling_rate_hz,
                                              const OutputOnlyOptions& options = {});

}  // namespace vibrissa::separation
