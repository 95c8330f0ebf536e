#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vibrissa::signals {

/// A signal at even times, estimated from samples at uneven times.
struct EvenEstimate {
  double start_s = 0., rate_hz = 0.;
  double band_hz = 0.;                  // the signal is taken to have no power above it
  std::vector<std::size_t> first = {};  // the signals' values: index of the first one in each piece
  std::vector<double> times_s = {};     // of all values
  std::vector<std::vector<double>> signals = {};
  double error_share =
      0.;  // rms of the expected error over the rms of a signal that fills the band
};

/// Minimum-variance linear estimate of band-limited signals (Kriging with the covariance
/// sin(2 pi B t)/(2 pi B t); Yen, IRE Transactions on Circuit Theory 3, 1956) from the nearest
/// samples, with B = 0.4 times the lower one of the mean rate and the new rate. Where the expected
/// error exceeds a tenth of the signal, as in a gap, there is no value, and a new piece begins
/// behind it. Throws UserError for times that do not increase. Proven by
/// tests/signals/spectra/uneven_resample_test.cc.
EvenEstimate resample_uneven(std::span<const double> times_s,
                             const std::vector<std::span<const double>>& signals, double rate_hz);

}  // namespace vibrissa::signals
