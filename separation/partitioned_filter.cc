#include "separation/partitioned_filter.h"

#include <algorithm>

namespace vibrissa::separation {

namespace {

Eigen::Map<Spectrum> spectrum_of(signals::RealFft& fft) {
  return {fft.spectrum().data(), static_cast<Eigen::Index>(fft.n_bins())};
}

}  // namespace

PartitionedFilter::PartitionedFilter(std::size_t block_length, std::size_t n_partitions,
                                     Constraint constraint)
    : block_length_(block_length),
      constraint_(constraint),
      weights_(static_cast<Eigen::Index>(block_length) + 1,
               static_cast<Eigen::Index>(n_partitions)) {
  clear();
}

void PartitionedFilter::clear() {
  weights_.setZero();
  next_constrained_ = 0;
}

void PartitionedFilter::apply(const SpectraBuffer& input, Spectrum& output) const {
  output = input.spectrum(0) * weights_.col(0);
  for (std::size_t p = 1; p < input.n_partitions(); ++p)
    output += input.spectrum(p) * weights_.col(static_cast<Eigen::Index>(p));
}

// What the transform holds as a spectrum loses the second half of its samples.
void PartitionedFilter::constrain(signals::RealFft& fft) const {
  fft.inverse();
  std::ranges::fill(fft.time().subspan(block_length_), 0.);
  fft.forward();
}

template <typename ErrorOf>
void PartitionedFilter::adapt_each(const SpectraBuffer& input, const ErrorOf& error_of,
                                   signals::RealFft& fft) {
  auto work = spectrum_of(fft);
  for (std::size_t p = 0; p < input.n_partitions(); ++p) {
    const auto j = static_cast<Eigen::Index>(p);
    if (constraint_ == Constraint::constrained) {
      work = input.spectrum(p).conjugate() * error_of(j);
      constrain(fft);
      weights_.col(j) += work;
    } else {
      weights_.col(j) += input.spectrum(p).conjugate() * error_of(j);
    }
  }
  if (constraint_ == Constraint::alternating) constrain_in_turn(fft);
}

void PartitionedFilter::adapt(const SpectraBuffer& input, const Spectrum& scaled_error,
                              signals::RealFft& fft) {
  adapt_each(
      input, [&](Eigen::Index) -> const Spectrum& { return scaled_error; }, fft);
}

void PartitionedFilter::adapt(const SpectraBuffer& input, const Spectrum& error,
                              const Eigen::ArrayXXd& step, signals::RealFft& fft) {
  adapt_each(
      input, [&](Eigen::Index p) { return step.col(p) * error; }, fft);
}

void PartitionedFilter::constrain_in_turn(signals::RealFft& fft) {
  auto work = spectrum_of(fft);
  work = weights_.col(next_constrained_);
  constrain(fft);
  weights_.col(next_constrained_) = work;
  next_constrained_ = (next_constrained_ + 1) % weights_.cols();
}

std::vector<double> PartitionedFilter::impulse_response(signals::RealFft& fft) const {
  std::vector<double> taps;
  taps.reserve(n_taps());
  for (Eigen::Index p = 0; p < weights_.cols(); ++p) {
    spectrum_of(fft) = weights_.col(p);
    fft.inverse();
    const auto head = fft.time().first(block_length_);
    taps.insert(taps.end(), head.begin(), head.end());
  }
  return taps;
}

}  // namespace vibrissa::separation
