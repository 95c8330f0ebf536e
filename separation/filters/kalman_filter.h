#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "separation/filters/block_separator.h"
#include "separation/filters/output_guard.h"
#include "separation/filters/partitioned_filter.h"
#include "separation/filters/spectra_buffer.h"
#include "signals/spectra/fft.h"

namespace vibrissa::separation {

struct KalmanOptions {
  std::size_t block_length = 64;
  /// Rounded up to whole partitions of block_length.
  std::size_t filter_length = 440;
  /// A of the model W[k + 1] = A W[k] + noise, 0 < A <= 1. 1: the path is constant, and the filter
  /// averages over all past samples. The filter follows a change within about 1 / (1 - A) blocks.
  double transition = 1.;
  /// Forgetting factor of the wind spectrum per block, in [0, 1).
  double noise_forgetting = 0.9;
};

/// Partitioned-block frequency-domain Kalman filter from base acceleration to base moment, diagonal
/// in bins and partitions (Enzner & Vary 2006; Kuech, Mabande & Enzner 2014). For each block
///   e = last half of ifft(sum_p X_p W_p),  e = M_r - e,
///   C_p <- A^2 C_p + (1 - A^2) |W_p|^2,   D = sum_p |X_p|^2 C_p / 2 + Psi,
///   W_p += constraint(C_p conj(X_p) E / D),   C_p <- C_p (1 - |X_p|^2 C_p / (2 D)),
/// with Psi the exponentially weighted mean of |E|^2. The factors 1/2 come from overlap-save: E has
/// block_length samples in a transform twice as long. With them C decreases as the covariance of
/// least squares for white input. The first C is the power of the moment divided by the power of
/// the acceleration, so that no absolute constant is needed. A block without moment or without
/// acceleration (a gap of zeros) does not change the filter. e is M_s_hat (OutputGuard states its
/// bound); latency block_length - 1. Proven by tests/separation/filters/kalman_filter_test.cc
/// against the least-squares solution.
class PartitionedKalman : public BlockSeparator {
 public:
  /// Throws UserError for options out of range, with the option's name.
  explicit PartitionedKalman(const KalmanOptions& options);

  std::string name() const override { return "Kalman"; }
  std::size_t n_taps() const { return filter_.n_taps(); }
  /// The present taps, from base acceleration to base moment.
  std::vector<double> impulse_response() { return filter_.impulse_response(fft_); }

 private:
  void process_block(std::span<const double> base_acceleration, std::span<const double> base_moment,
                     std::span<double> wind_moment) override;
  void reset_blocks() override;
  void learn();
  void forget();
  /// Sets the prior when there is none yet or the moment is far above it.
  void renew_prior(const Eigen::ArrayXd& error_power);

  KalmanOptions options_;
  signals::RealFft fft_;
  SpectraBuffer input_;
  PartitionedFilter filter_;
  Spectrum error_;
  Eigen::ArrayXXd covariance_, gain_;  // [bin][partition]
  Eigen::ArrayXd wind_power_, expected_power_;
  OutputGuard guard_;
  double prior_ = 0., sum_of_errors_ = 0., sum_of_heard_ = 0.;
  bool has_wind_power_ = false;
};

}  // namespace vibrissa::separation
