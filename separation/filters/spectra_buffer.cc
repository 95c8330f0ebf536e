#include "separation/filters/spectra_buffer.h"

#include <algorithm>
#include <cassert>

namespace vibrissa::separation {

SpectraBuffer::SpectraBuffer(std::size_t block_length, std::size_t n_partitions)
    : spectra_(static_cast<Eigen::Index>(block_length) + 1,
               static_cast<Eigen::Index>(n_partitions)),
      powers_(spectra_.rows(), spectra_.cols()),
      power_(spectra_.rows()),
      last_block_(static_cast<Eigen::Index>(block_length)) {
  clear();
}

void SpectraBuffer::clear() {
  spectra_.setZero();
  powers_.setZero();
  power_.setZero();
  last_block_.setZero();
  newest_ = 0;
}

void SpectraBuffer::push(std::span<const double> block, signals::RealFft& fft) {
  const Eigen::Index n = last_block_.size();
  assert(static_cast<Eigen::Index>(block.size()) == n && fft.size() == 2 * block.size());
  const Eigen::Map<const Eigen::ArrayXd> next(block.data(), n);
  Eigen::Map<Eigen::ArrayXd> time(fft.time().data(), 2 * n);
  time.head(n) = last_block_;
  time.tail(n) = next;
  last_block_ = next;
  fft.forward();
  newest_ = (newest_ + spectra_.cols() - 1) % spectra_.cols();
  spectra_.col(newest_) = Eigen::Map<const Spectrum>(fft.spectrum().data(), spectra_.rows());
  powers_.col(newest_) = spectra_.col(newest_).abs2();
  // Summed again each time: a running sum would accumulate rounding errors.
  power_ = powers_.col(0);
  for (Eigen::Index p = 1; p < powers_.cols(); ++p) power_ += powers_.col(p);
}

}  // namespace vibrissa::separation
