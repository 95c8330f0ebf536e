#pragma once

#include <span>
#include <vector>

namespace vibrissa::signals {

/// Even samples as a low-passed signal that is known between them, by a sinc under a Kaiser window
/// (beta 8, 80 dB). Proven by tests/signals/files/joined_recording_test.cc.
class BandLimitedSignal {
 public:
  /// cutoff: in cycles a sample, below one half. half_length: of the kernel, in samples. The
  /// samples must outlive it.
  BandLimitedSignal(std::span<const double> samples, double cutoff, double half_length);
  /// For values at a rate that is not higher than the samples' own: flat to flat_share of it, with
  /// a kernel of half_length of its samples to either side.
  static BandLimitedSignal at_rate(std::span<const double> samples, double own_rate_hz,
                                   double rate_hz);
  static constexpr double half_length_samples = 32., flat_share = 0.38;

  /// The value at a place between the first and the last sample (samples, from 0); near the ends
  /// the kernel is cut and scaled.
  double at(double place) const;

 private:
  double kernel(double lag) const;

  std::span<const double> samples_;
  double half_length_, steps_per_sample_;
  std::vector<double> table_;  // of the kernel at positive lags
};

}  // namespace vibrissa::signals
