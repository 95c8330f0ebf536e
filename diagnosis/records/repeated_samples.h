#pragma once

#include <span>
#include <vector>

namespace vibrissa::diagnosis {

/// Does a channel hold so many samples equal to the one before that it is polled faster than it is
/// renewed? Steps of a coarse converter repeat by themselves and do not count.
bool is_held(std::span<const double> x);
/// Share of the samples that equal the one before.
double repeat_share(std::span<const double> x);

/// What the source gave, band-limited, at the times of x: the first of each run of equal samples,
/// at the steady rate at which runs begin. Late by the age of a fresh sample, less than one period
/// of the source. Proven by tests/diagnosis/records/repeated_samples_test.cc.
std::vector<double> new_sample_series(std::span<const double> x);

/// Range within which the age of a fresh sample is unknown [samples]: which samples repeat tells
/// when a source is read to a q-th of its period, where q polls see a whole number of samples.
/// Nothing where the rates have no simple ratio, as every place of the period is seen then. Proven
/// by tests/diagnosis/records/repeated_samples_test.cc.
double unknown_age(std::span<const double> x);

}  // namespace vibrissa::diagnosis
