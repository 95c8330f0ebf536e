#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "separation/filters/spectra_buffer.h"
#include "signals/spectra/fft.h"

namespace vibrissa::separation {

/// How the filter is constrained to a linear convolution (second half of the taps of each partition
/// zero).
enum class Constraint {
  constrained,   // every partition in every block: two transforms each
  alternating,   // one partition in each block, in turn
  unconstrained  // never: the error of the circular convolution remains
};

/// FIR filter in the frequency domain, cut into P partitions of the block length
/// (partitioned-block overlap-save; Soo & Pang 1990), together with the spectra of its input. Two
/// partitions, h = ceil(P / 2) blocks apart, share one complex transform: with U = X_p - j X_{p+h}
/// and V = W_p + j W_{p+h} over the whole circle of bins,
///   y = Re ifft(sum U V),   V += fft(constraint(ifft(conj(U) E)))
/// give the results of both partitions, and the pairs stay the same when the input advances by a
/// block. This needs half as many transforms of the same length, and one complex transform is
/// faster than two real ones. Step sizes are not part of this class: adapt() takes the scaled
/// error. Proven by tests/separation/filters/paired_filter_test.cc against plain convolution and
/// correlation.
class PairedFilter {
 public:
  PairedFilter(std::size_t block_length, std::size_t n_partitions, Constraint constraint);

  std::size_t n_partitions() const { return static_cast<std::size_t>(powers_.cols()); }
  std::size_t n_taps() const { return block_length_ * n_partitions(); }
  Eigen::Index n_bins() const { return powers_.rows(); }

  /// Resets the input and the taps.
  void clear();
  void clear_taps();
  /// Takes the next block of the input.
  void push(std::span<const double> block);
  /// Output of the filter for the last block.
  void apply(std::span<double> output);
  /// Sum over the partitions of |X_p|^2, by bin.
  const Eigen::ArrayXd& power() const { return power_; }
  /// W_p += conj(X_p) scaled_error for every p, then the constraint. scaled_error: bins 0 ..
  /// block_length of the error in the second half of the transform.
  void adapt(const Spectrum& scaled_error);
  void scale(double factor) { weights_ *= factor; }
  /// The taps in the time domain.
  std::vector<double> impulse_response();

 private:
  Eigen::Index length() const { return weights_.rows(); }
  Eigen::Index n_pairs() const { return weights_.cols(); }
  bool has_odd_end() const { return n_partitions() % 2 == 1; }
  Eigen::Index place(Eigen::Index pair) const { return (newest_ + pair) % n_pairs(); }
  using Buffer = Eigen::Map<Spectrum, Eigen::Aligned64>;  // as signals::ComplexFft has them
  Buffer time() { return {fft_.time().data(), length()}; }
  Buffer spectrum() { return {fft_.spectrum().data(), length()}; }
  auto spectrum_back(Eigen::Index n_blocks) const {
    return spectra_.col((newest_spectrum_ + n_blocks) % spectra_.cols());
  }
  void pair_newest();
  void take_power();
  void separate_last();
  void constrain(bool alone);

  std::size_t block_length_;
  Constraint constraint_;
  signals::ComplexFft fft_;
  signals::RealFft real_fft_;
  Eigen::ArrayXXcd input_, weights_;  // U and V: [bin of the whole circle][pair]
  Spectrum error_;                    // over the whole circle
  Eigen::ArrayXd last_block_;
  Eigen::ArrayXXcd spectra_;  // X of the last blocks: [bin][place]
  Eigen::ArrayXXd powers_;    // |X_p|^2 and their sums: [bin][place]
  Eigen::ArrayXd round_power_, power_;
  Eigen::Index newest_ = 0, newest_spectrum_ = 0, next_power_ = 0, next_constrained_ = 0;
};

}  // namespace vibrissa::separation
