#include "separation/paired_filter.h"

#include <algorithm>
#include <cassert>

namespace vibrissa::separation {

namespace {

Eigen::Index count_pairs(std::size_t n_partitions) {
  return static_cast<Eigen::Index>((n_partitions + 1) / 2);
}

}  // namespace

PairedFilter::PairedFilter(std::size_t block_length, std::size_t n_partitions,
                           Constraint constraint)
    : block_length_(block_length),
      constraint_(constraint),
      fft_(2 * block_length),
      input_(static_cast<Eigen::Index>(2 * block_length), count_pairs(n_partitions)),
      weights_(input_.rows(), input_.cols()),
      error_(input_.rows()),
      history_(input_.rows() + input_.cols() * static_cast<Eigen::Index>(block_length)),
      powers_(static_cast<Eigen::Index>(block_length) + 1, static_cast<Eigen::Index>(n_partitions)),
      power_(powers_.rows()) {
  clear();
}

void PairedFilter::clear() {
  clear_taps();
  input_.setZero();
  history_.setZero();
  powers_.setZero();
  power_.setZero();
  newest_ = newest_power_ = 0;
}

void PairedFilter::clear_taps() {
  weights_.setZero();
  next_constrained_ = 0;
}

void PairedFilter::push(std::span<const double> block) {
  const auto n = static_cast<Eigen::Index>(block_length_);
  assert(block.size() == block_length_);
  std::copy(history_.begin() + n, history_.end(), history_.begin());
  history_.tail(n) = Eigen::Map<const Eigen::ArrayXd>(block.data(), n);

  time().real() = history_.tail(length());
  time().imag() = -history_.head(length());
  fft_.forward();
  newest_ = (newest_ + n_pairs() - 1) % n_pairs();
  input_.col(newest_) = spectrum();
  take_power();
  if (n_partitions() % 2 == 1) separate_last();
}

// An odd number of partitions leaves the last without a partner: X alone, half of the sum with the
// mirror image.
void PairedFilter::separate_last() {
  auto last = input_.col(place(n_pairs() - 1));
  auto pair = spectrum();
  pair = last;
  const Eigen::Index n = length() - 1;
  last[0] = pair[0].real();
  last.tail(n) = 0.5 * (pair.tail(n) + pair.tail(n).reverse().conjugate());
}

// Bin k and its mirror image hold X_p -+ j X_{p+h}: the newest X_p is half their sum.
void PairedFilter::take_power() {
  const Eigen::Index n = powers_.rows() - 1;
  newest_power_ = (newest_power_ + powers_.cols() - 1) % powers_.cols();
  const auto newest = input_.col(newest_);
  auto power = powers_.col(newest_power_);
  power[0] = newest[0].real() * newest[0].real();
  power.tail(n) = 0.25 * (newest.segment(1, n) + newest.tail(n).reverse().conjugate()).abs2();
  // Summed anew each time: a running sum would keep the rounding of what has left it.
  power_ = powers_.col(0);
  for (Eigen::Index p = 1; p < powers_.cols(); ++p) power_ += powers_.col(p);
}

void PairedFilter::apply(std::span<double> output) {
  auto sum = spectrum();
  sum = input_.col(place(0)) * weights_.col(0);
  for (Eigen::Index q = 1; q < n_pairs(); ++q) sum += input_.col(place(q)) * weights_.col(q);
  fft_.inverse();
  const auto n = static_cast<Eigen::Index>(block_length_);
  Eigen::Map<Eigen::ArrayXd>(output.data(), n) =
      time().tail(n).real() * (1. / static_cast<double>(length()));
}

// The spectrum's samples lose their second half.
void PairedFilter::constrain() {
  fft_.inverse();
  time().tail(static_cast<Eigen::Index>(block_length_)).setZero();
  fft_.forward();
}

void PairedFilter::adapt(const Spectrum& scaled_error) {
  const auto n = static_cast<Eigen::Index>(block_length_);
  const double scale = 1. / static_cast<double>(length());  // the inverse transform leaves it out
  const bool constrained = constraint_ == Constraint::constrained;
  error_.head(n + 1) = scaled_error * (constrained ? scale : 1.);
  error_.tail(n - 1) = error_.segment(1, n - 1).reverse().conjugate();
  for (Eigen::Index q = 0; q < n_pairs(); ++q) {
    if (constrained) {
      spectrum() = input_.col(place(q)).conjugate() * error_;
      constrain();
      weights_.col(q) += spectrum();
    } else {
      weights_.col(q) += input_.col(place(q)).conjugate() * error_;
    }
  }
  if (constraint_ != Constraint::alternating) return;
  spectrum() = weights_.col(next_constrained_) * scale;
  constrain();
  weights_.col(next_constrained_) = spectrum();
  next_constrained_ = (next_constrained_ + 1) % n_pairs();
}

std::vector<double> PairedFilter::impulse_response() {
  std::vector<double> taps(2 * block_length_ * static_cast<std::size_t>(n_pairs()));
  const auto n = static_cast<Eigen::Index>(block_length_);
  for (Eigen::Index q = 0; q < n_pairs(); ++q) {
    spectrum() = weights_.col(q) / static_cast<double>(length());
    fft_.inverse();
    Eigen::Map<Eigen::ArrayXd>(taps.data() + q * n, n) = time().head(n).real();
    Eigen::Map<Eigen::ArrayXd>(taps.data() + (q + n_pairs()) * n, n) = time().head(n).imag();
  }
  taps.resize(n_taps());
  return taps;
}

}  // namespace vibrissa::separation
