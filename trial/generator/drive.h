#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vibrissa::trial {

/// One period of a multisine on odd lines between low and high, every fourth of them left out as a
/// detection line, with random phases; n samples, given rms.
std::vector<double> odd_multisine(std::size_t n, double rate_hz, double low_hz, double high_hz,
                                  double rms, std::uint64_t seed);

/// Gaussian noise with a flat density between low and high and none outside; n samples, given rms.
std::vector<double> band_noise(std::size_t n, double rate_hz, double low_hz, double high_hz,
                               double rms, std::uint64_t seed);

/// The part of a signal below a frequency, as a filter without delay leaves it.
std::vector<double> below(std::vector<double> x, double rate_hz, double high_hz);

}  // namespace vibrissa::trial
