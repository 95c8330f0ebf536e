#include "separation/filters/partitioned_filter.h"

#include <algorithm>

namespace vibrissa::separation {

namespace {

Eigen::Map<Spectrum> spectrum_of(signals::RealFft& fft) {
  return {fft.spectrum().data(), static_cast<Eigen::Index>(fft.n_bins())};
}

}  // namespace

PartitionedFilter::PartitionedFilter(std::size_t block_length, std::size_t n_partitions)
    : block_length_(block_length),
      weights_(static_cast<Eigen::Index>(block_length) + 1,
               static_cast<Eigen::Index>(n_partitions)) {
  clear();
}

void PartitionedFilter::clear() {
  weights_.setZero();
}

void PartitionedFilter::apply(const SpectraBuffer& input, Spectrum& output) const {
  output = input.spectrum(0) * weights_.col(0);
  for (std::size_t p = 1; p < input.n_partitions(); ++p)
    output += input.spectrum(p) * weights_.col(static_cast<Eigen::Index>(p));
}

void PartitionedFilter::adapt(const SpectraBuffer& input, const Spectrum& error,
                              const Eigen::ArrayXXd& step, signals::RealFft& fft) {
  auto update = spectrum_of(fft);
  for (std::size_t p = 0; p < input.n_partitions(); ++p) {
    const auto j = static_cast<Eigen::Index>(p);
    update = input.spectrum(p).conjugate() * (step.col(j) * error);
    fft.inverse();
    std::ranges::fill(fft.time().subspan(block_length_), 0.);
    fft.forward();
    weights_.col(j) += update;
  }
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
