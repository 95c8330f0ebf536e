#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "diagnosis/model/nominal_model.h"

namespace vibrissa::diagnosis {

/// Spectrum of an accelerometer's reading [m/s^2]; the lines below end show its noise.
struct NoiseLines {
  std::vector<Complex> spectrum;  // lines 0 .. n/2, unscaled
  std::size_t end = 0;
  bool of_source = false;  // of the source's samples instead of the reading
  double age_range = 0.;   // range of the unknown age of its readings [samples]
};

/// Uses all lines of a channel without repeats and images.
NoiseLines all_lines(std::span<const double> x);

/// Excludes repeated samples and images of motion, which are not noise. With sample-and-hold
/// repeats it uses the source's own series up to half the source's rate; with asynchronous sampling
/// of a moving base, the series resampled to equal ages. Proven by
/// tests/diagnosis/records/accelerometer_noise_test.cc.
NoiseLines noise_lines(std::span<const double> reading, double rate_hz, bool moves);

}  // namespace vibrissa::diagnosis
