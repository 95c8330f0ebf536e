#include "signals/spectra/band_limited_signal.h"

#include <algorithm>
#include <cmath>

#include "signals/spectra/kaiser_sinc.h"

namespace vibrissa::signals {

namespace {

// Straight lines between its entries are exact to 1e-6.
constexpr std::size_t n_steps = 1 << 15;

}  // namespace

BandLimitedSignal::BandLimitedSignal(const std::span<const double> samples, const double cutoff,
                                     const double half_length)
    : samples_(samples),
      half_length_(half_length),
      steps_per_sample_(double(n_steps) / half_length),
      table_(n_steps + 2) {
  const KaiserSinc low_pass{.cut_off = cutoff, .half_length = half_length, .shape = 8.};
  for (std::size_t i = 0; i < table_.size(); ++i)
    table_[i] = low_pass(double(i) / steps_per_sample_);
}

BandLimitedSignal BandLimitedSignal::at_rate(const std::span<const double> samples,
                                             const double own_rate_hz, const double rate_hz) {
  constexpr double cutoff_share = 0.42;
  const double step = own_rate_hz / rate_hz;
  return {samples, cutoff_share / step, half_length_samples * step};
}

double BandLimitedSignal::kernel(const double lag) const {
  const double step = std::abs(lag) * steps_per_sample_;
  const auto below = static_cast<std::size_t>(step);
  return std::lerp(table_[below], table_[below + 1], step - double(below));
}

double BandLimitedSignal::at(const double place) const {
  const double first = std::max(0., std::ceil(place - half_length_));
  const double last = std::min(double(samples_.size() - 1), std::floor(place + half_length_));
  double sum = 0., weights = 0.;
  for (double i = first; i <= last; i += 1.) {
    const double weight = kernel(i - place);
    sum += weight * samples_[std::size_t(i)];
    weights += weight;
  }
  return sum / weights;
}

}  // namespace vibrissa::signals
