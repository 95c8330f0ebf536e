#include "separation/filters/paired_filter.h"

#include <algorithm>
#include <cassert>
#include <complex>

namespace vibrissa::separation {

namespace {

Eigen::Index count_pairs(std::size_t n_partitions) {
  return static_cast<Eigen::Index>((n_partitions + 1) / 2);
}

// Does the work for rows 0 .. n - 1, some at a time: what is summed over many columns then stays in
// registers. work takes a view: chunk(column) is the rows in turn.
template <typename Work>
void in_chunks(Eigen::Index n, Work work) {
  constexpr int size = 8;
  Eigen::Index first = 0;
  for (; first + size <= n; first += size)
    work([first](auto&& column) { return column.template segment<size>(first); });
  if (first < n) work([first, n](auto&& column) { return column.segment(first, n - first); });
}

// The place before one in a ring.
Eigen::Index step_back(Eigen::Index place, Eigen::Index n_places) {
  return (place + n_places - 1) % n_places;
}

}  // namespace

PairedFilter::PairedFilter(std::size_t block_length, std::size_t n_partitions,
                           Constraint constraint)
    : block_length_(block_length),
      constraint_(constraint),
      fft_(2 * block_length),
      real_fft_(2 * block_length),
      input_(static_cast<Eigen::Index>(2 * block_length), count_pairs(n_partitions)),
      weights_(input_.rows(), input_.cols()),
      error_(input_.rows()),
      last_block_(static_cast<Eigen::Index>(block_length)),
      spectra_(static_cast<Eigen::Index>(block_length) + 1, input_.cols() + 1),
      powers_(spectra_.rows(), static_cast<Eigen::Index>(n_partitions)),
      round_power_(powers_.rows()),
      power_(powers_.rows()) {
  clear();
}

void PairedFilter::clear() {
  clear_taps();
  input_.setZero();
  last_block_.setZero();
  spectra_.setZero();
  powers_.setZero();
  power_.setZero();
  round_power_.setZero();
  newest_ = newest_spectrum_ = next_power_ = 0;
}

void PairedFilter::clear_taps() {
  weights_.setZero();
  next_constrained_ = 0;
}

void PairedFilter::push(std::span<const double> block) {
  const auto n = static_cast<Eigen::Index>(block_length_);
  assert(block.size() == block_length_);
  Eigen::Map<Eigen::ArrayXd> time(real_fft_.time().data(), 2 * n);
  time.head(n) = last_block_;
  last_block_ = Eigen::Map<const Eigen::ArrayXd>(block.data(), n);
  time.tail(n) = last_block_;
  real_fft_.forward();

  newest_ = step_back(newest_, input_.cols());
  newest_spectrum_ = step_back(newest_spectrum_, spectra_.cols());
  spectra_.col(newest_spectrum_) = Eigen::Map<const Spectrum>(real_fft_.spectrum().data(), n + 1);
  pair_newest();
  if (has_odd_end() && constraint_ != Constraint::constrained) separate_last();
  take_power();
}

// X_0 - j X_h, whose mirror image is conj(X_0 + j X_h).
void PairedFilter::pair_newest() {
  constexpr std::complex<double> j(0., 1.);
  const Eigen::Index n = spectra_.rows() - 1;
  const auto first = spectrum_back(0), second = spectrum_back(n_pairs());
  auto pair = input_.col(newest_);
  pair.head(n + 1) = first - j * second;
  pair.tail(n - 1) = (first + j * second).segment(1, n - 1).reverse().conjugate();
}

// With an odd number of partitions the last one has no partner. When every update is constrained,
// its pair may contain another spectrum, because the imaginary taps for it stay zero.
void PairedFilter::separate_last() {
  const Eigen::Index n = spectra_.rows() - 1;
  const auto alone = spectrum_back(n_pairs() - 1);
  auto pair = input_.col(place(n_pairs() - 1));
  pair.head(n + 1) = alone;
  pair.tail(n - 1) = alone.segment(1, n - 1).reverse().conjugate();
}

// Sums of what the ring holds, each of non-negative terms that are in it: a sum from which the
// oldest is subtracted would keep its rounding. Places from next_power_ on hold sums to the last
// place, of the round before.
void PairedFilter::take_power() {
  powers_.col(next_power_) = spectrum_back(0).abs2();
  round_power_ += powers_.col(next_power_);
  if (++next_power_ < powers_.cols()) {
    power_ = round_power_ + powers_.col(next_power_);
    return;
  }
  power_ = round_power_;
  for (Eigen::Index p = powers_.cols() - 1; p > 0; --p) powers_.col(p - 1) += powers_.col(p);
  round_power_.setZero();
  next_power_ = 0;
}

void PairedFilter::apply(std::span<double> output) {
  auto products = spectrum();
  in_chunks(length(), [this, &products](auto chunk) {
    auto sum = (chunk(input_.col(place(0))) * chunk(weights_.col(0))).eval();
    for (Eigen::Index q = 1; q < n_pairs(); ++q)
      sum += chunk(input_.col(place(q))) * chunk(weights_.col(q));
    chunk(products) = sum;
  });
  fft_.inverse();
  const auto n = static_cast<Eigen::Index>(block_length_);
  Eigen::Map<Eigen::ArrayXd>(output.data(), n) =
      time().tail(n).real() / static_cast<double>(length());
}

// The spectrum's samples lose their second half and, where they belong to one partition alone,
// their imaginary part.
void PairedFilter::constrain(bool alone) {
  fft_.inverse();
  const auto n = static_cast<Eigen::Index>(block_length_);
  if (alone) time().head(n) = time().head(n).real().cast<std::complex<double>>();
  time().tail(n).setZero();
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
      constrain(has_odd_end() && q + 1 == n_pairs());
      weights_.col(q) += spectrum();
    } else {
      weights_.col(q) += input_.col(place(q)).conjugate() * error_;
    }
  }
  if (constraint_ != Constraint::alternating) return;
  spectrum() = weights_.col(next_constrained_) * scale;
  constrain(false);
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
