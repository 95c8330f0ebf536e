#pragma once

#include <optional>
#include <span>
#include <vector>

namespace vibrissa::diagnosis {

/// The samples at one age, and the range within which that is unknown [samples].
struct EvenedSeries {
  std::vector<double> samples;
  double unknown_age = 0.;
};

/// What an accelerometer would have read with samples of one age, where it renews faster than it is
/// read, at 800, 1600 or 3200 Hz: sample k is frac(k r / f + p) / r old (source rate r, reading
/// rate f), which repeats after q samples, r / f = P / q, and leaves images of what moves the base
/// at multiples of f / q. The mean age stays. Of the sources and their q patterns it is the one
/// without which the quietest part of the spectrum is loudest. Nothing where none makes that part
/// quieter by half: no image stands out of the noise there. rate_hz: f. Proven by
/// tests/diagnosis/records/asynchronous_sampling_test.cc.
std::optional<EvenedSeries> evened_series(std::span<const double> x, double rate_hz);

}  // namespace vibrissa::diagnosis
