#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "separation/spectra_buffer.h"
#include "signals/fft.h"

namespace vibrissa::separation {

/// What keeps the filter a linear convolution (the second half of each partition's taps zero).
enum class Constraint {
  constrained,   // every partition, every block: two transforms each
  alternating,   // every block, but one partition in turn
  unconstrained  // never: circular wrap-around stays as an error
};

/// FIR filter in the frequency domain, cut into partitions of the block length (partitioned-block
/// overlap-save; Soo & Pang 1990). Knows nothing of step sizes: adapt() takes the scaled error.
/// Proven by tests/separation/partitioned_filter_test.cc against plain convolution.
class PartitionedFilter {
 public:
  PartitionedFilter(std::size_t block_length, std::size_t n_partitions, Constraint constraint);

  std::size_t n_taps() const { return block_length_ * static_cast<std::size_t>(weights_.cols()); }
  void clear();
  /// Sum over the partitions of X_p W_p.
  void apply(const SpectraBuffer& input, Spectrum& output) const;
  /// W_p += conj(X_p) scaled_error, then the constraint; fft: length 2 block_length.
  void adapt(const SpectraBuffer& input, const Spectrum& scaled_error, signals::RealFft& fft);
  /// The same with a step for each bin and partition: W_p += conj(X_p) step_p error.
  void adapt(const SpectraBuffer& input, const Spectrum& error, const Eigen::ArrayXXd& step,
             signals::RealFft& fft);
  /// |W_p|^2, [bin][partition].
  auto power() const { return weights_.abs2(); }
  void scale(double factor) { weights_ *= factor; }
  /// The filter's taps in time.
  std::vector<double> impulse_response(signals::RealFft& fft) const;

 private:
  void constrain(signals::RealFft& fft) const;
  void constrain_in_turn(signals::RealFft& fft);
  template <typename ErrorOf>
  void adapt_each(const SpectraBuffer& input, const ErrorOf& error_of, signals::RealFft& fft);

  std::size_t block_length_;
  Constraint constraint_;
  Eigen::ArrayXXcd weights_;  // [bin][partition]
  Eigen::Index next_constrained_ = 0;
};

}  // namespace vibrissa::separation
