#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "separation/filters/spectra_buffer.h"
#include "signals/spectra/fft.h"

namespace vibrissa::separation {

/// FIR filter in the frequency domain, divided into partitions of the block length
/// (partitioned-block overlap-save; Soo & Pang 1990), with a separate step for each bin and
/// partition; every update is constrained to a linear convolution (the second half of each
/// partition's taps zero). PairedFilter is faster when all partitions have the same step. Proven by
/// tests/separation/filters/partitioned_filter_test.cc against plain convolution.
class PartitionedFilter {
 public:
  PartitionedFilter(std::size_t block_length, std::size_t n_partitions);

  std::size_t n_taps() const { return block_length_ * static_cast<std::size_t>(weights_.cols()); }
  void clear();
  /// Sum over the partitions of X_p W_p.
  void apply(const SpectraBuffer& input, Spectrum& output) const;
  /// W_p += conj(X_p) step_p error, then the constraint; fft: length 2 block_length.
  void adapt(const SpectraBuffer& input, const Spectrum& error, const Eigen::ArrayXXd& step,
             signals::RealFft& fft);
  /// |W_p|^2, [bin][partition].
  auto power() const { return weights_.abs2(); }
  /// The taps in the time domain.
  std::vector<double> impulse_response(signals::RealFft& fft) const;

 private:
  std::size_t block_length_;
  Eigen::ArrayXXcd weights_;  // [bin][partition]
};

}  // namespace vibrissa::separation
