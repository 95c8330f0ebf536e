#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vibrissa::signals {

struct BandNoise {
  double low_hz = 0., high_hz = 0.;
  double peak = 1.;  // of the samples
  std::size_t n_samples = 0;
  std::uint64_t seed = 0;
};

/// Gaussian noise with a flat spectrum between low and high, and no power elsewhere: every line of
/// the record in the band has an independent complex normal amplitude. The noise is periodic
/// without a step. Equal seeds give equal noise with every standard library. Throws UserError
/// unless 0 < low <= high < half the sampling rate, the peak is not negative, and a line lies in
/// the band. Proven by tests/signals/excitation/band_noise_test.cc.
std::vector<double> sample(const BandNoise& noise, double sampling_rate_hz);

}  // namespace vibrissa::signals
