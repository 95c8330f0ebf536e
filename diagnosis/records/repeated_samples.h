#pragma once

#include <span>
#include <vector>

namespace vibrissa::diagnosis {

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
