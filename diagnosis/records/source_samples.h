#pragma once

#include <optional>
#include <span>
#include <vector>

namespace vibrissa::diagnosis {

/// The samples resampled to one age, and the range of that unknown age [samples].
struct EvenedSeries {
  std::vector<double> samples;
  double unknown_age = 0.;
};

/// Corrects asynchronous sampling: an accelerometer that updates at 800, 1600 or 3200 Hz is read at
/// a lower rate. Sample k then has the age frac(k r / f + p) / r (source rate r, reading rate f).
/// With r / f = P / q the ages repeat after q samples and cause images of the motion at multiples
/// of f / q. The result has the samples at one age, the mean age. Of all source rates and their q
/// patterns the one is chosen that lowers the quietest part of the spectrum most. Nothing when none
/// lowers it by half, because then no image exceeds the noise. rate_hz: f. Proven by
/// tests/diagnosis/records/asynchronous_sampling_test.cc.
std::optional<EvenedSeries> evened_series(std::span<const double> x, double rate_hz);

/// Does a channel have sample-and-hold repeats, because it is read faster than its source is
/// updated? Repeats by the steps of a coarse converter do not count.
bool is_held(std::span<const double> x);
/// Share of the samples that equal the sample before.
double repeat_share(std::span<const double> x);

/// The source's own samples, interpolated (band-limited) to the times of x: the first of each run
/// of equal samples, at the constant rate at which runs begin. Delayed by the age of a new sample,
/// less than one period of the source. Proven by tests/diagnosis/records/repeated_samples_test.cc.
std::vector<double> new_sample_series(std::span<const double> x);

/// Range of the unknown age of a new sample [samples]. The pattern of repeats determines the
/// reading time to 1/q of the source's period, when q readings span a whole number of source
/// samples. 0 when the rates have no simple ratio, because then all positions in the period occur.
/// Proven by tests/diagnosis/records/repeated_samples_test.cc.
double unknown_age(std::span<const double> x);

}  // namespace vibrissa::diagnosis
