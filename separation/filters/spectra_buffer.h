#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "signals/spectra/fft.h"

namespace vibrissa::separation {

using Spectrum = Eigen::ArrayXcd;
using SpectrumRef = Eigen::Ref<const Eigen::ArrayXcd>;

/// Spectra of the last input blocks for overlap-save: spectrum p is the spectrum of the two
/// consecutive blocks that end p blocks ago (2 block_length samples, the newest last). Proven by
/// tests/separation/filters/partitioned_filter_test.cc.
class SpectraBuffer {
 public:
  SpectraBuffer(std::size_t block_length, std::size_t n_partitions);

  /// Takes the next block; fft has the length 2 block_length.
  void push(std::span<const double> block, signals::RealFft& fft);
  void clear();
  std::size_t n_partitions() const { return static_cast<std::size_t>(spectra_.cols()); }
  Eigen::Index n_bins() const { return spectra_.rows(); }
  /// Partition 0 is the newest.
  auto spectrum(std::size_t partition) const { return spectra_.col(place(partition)); }
  /// |X_p|^2 by bin.
  auto power(std::size_t partition) const { return powers_.col(place(partition)); }
  /// Sum over the partitions of |X_p|^2, by bin.
  const Eigen::ArrayXd& power() const { return power_; }

 private:
  Eigen::Index place(std::size_t partition) const {
    return (newest_ + static_cast<Eigen::Index>(partition)) % spectra_.cols();
  }

  Eigen::ArrayXXcd spectra_;  // [bin][place]
  Eigen::ArrayXXd powers_;    // [bin][place]
  Eigen::ArrayXd power_, last_block_;
  Eigen::Index newest_ = 0;
};

}  // namespace vibrissa::separation
