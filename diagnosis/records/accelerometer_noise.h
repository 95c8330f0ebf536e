#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "diagnosis/model/nominal_model.h"

namespace vibrissa::diagnosis {

/// Spectrum of an accelerometer's reading [m/s^2], of which the lines below end tell its noise.
struct NoiseLines {
  std::vector<Complex> spectrum;  // lines 0 .. n/2, unscaled
  std::size_t end = 0;
  bool of_source = false;  // of what the reading was made from
  double age_range = 0.;   // within which its readings' age is unknown [samples]
};

/// All lines of a channel that hides nothing.
NoiseLines all_lines(std::span<const double> x);

/// Samples that are read again say nothing anew, and images of a motion are no noise: of a channel
/// that is polled faster than it is renewed the source's own series, up to half its rate, and of
/// one that moves and has uneven ages the evened one. Proven by
/// tests/diagnosis/records/accelerometer_noise_test.cc.
NoiseLines noise_lines(std::span<const double> reading, double rate_hz, bool moves);

}  // namespace vibrissa::diagnosis
