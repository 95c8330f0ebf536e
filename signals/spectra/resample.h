#pragma once

#include <span>
#include <vector>

namespace vibrissa::signals {

/// Resamples a finite record to another rate by a polyphase windowed-sinc filter (rates in a ratio
/// of small whole numbers): the pass band is flat within 0.1 % up to flat_to_share of the lower
/// Nyquist frequency; images and aliases are below -80 dB from the Nyquist frequency on; there is
/// no delay. A share near 1 needs a long filter: 57 samples of the lower rate for 0.8, forty times
/// as many for 0.995. The edges are extended by point reflection. Sample j of the result is at j /
/// to_hz; there are ceil(n to_hz / from_hz) samples, all within the duration n / from_hz of the
/// record. Equal rates return the record unchanged. Proven by
/// tests/signals/spectra/resample_test.cc. Throws UserError when the ratio is not a ratio of whole
/// numbers up to 1000 or the share is not between 0 and 1.
std::vector<double> resample(std::span<const double> x, double from_hz, double to_hz,
                             double flat_to_share = 0.8);

/// Subtracts the mean.
std::vector<double> remove_mean(std::span<const double> x);

/// Maps the smallest value to low and the largest to high, linearly. Throws UserError for a
/// constant, for no values and for values that are not finite.
std::vector<double> scale_to_range(std::span<const double> x, double low, double high);

}  // namespace vibrissa::signals
