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

}  // namespace vibrissa::diagnosis
