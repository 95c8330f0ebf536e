#pragma once

#include <cstddef>
#include <vector>

namespace vibrissa::signals {

enum class SweepLaw {
  linear,      // equal time for each hertz
  logarithmic  // equal time for each octave
};

struct SweptSine {
  double low_hz = 0.,
         high_hz = 0.;  // at the first sample and after the last; high may be below low
  SweepLaw law = SweepLaw::logarithmic;
  double peak = 1.;
  std::size_t n_samples = 0;
  std::size_t fade_samples = 0;  // at both ends, sine squared, so that there is no step
};

/// peak sin(phase(t)), phase' = 2 pi f(t), phase(0) = 0: f = low + (high - low) t / T, or
/// low (high / low)^(t / T). Throws UserError unless 0 < low, high < half the sampling rate, the
/// peak is not negative, there are samples, and both fades fit.
/// Proven by tests/signals/excitation/swept_sine_test.cc.
std::vector<double> sample(const SweptSine& sweep, double sampling_rate_hz);

}  // namespace vibrissa::signals
