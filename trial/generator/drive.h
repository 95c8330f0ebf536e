#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vibrissa::trial {

/// One period of a multisine with random phases on odd lines between low and high; every fourth odd
/// line is a detection line and not excited. n samples with the given rms.
std::vector<double> odd_multisine(std::size_t n, double rate_hz, double low_hz, double high_hz,
                                  double rms, std::uint64_t seed);

/// Gaussian noise with constant density between low and high and zero outside; n samples with the
/// given rms.
std::vector<double> band_noise(std::size_t n, double rate_hz, double low_hz, double high_hz,
                               double rms, std::uint64_t seed);

/// The part of a signal below a frequency, by a zero-phase filter.
std::vector<double> below(std::vector<double> x, double rate_hz, double high_hz);

}  // namespace vibrissa::trial
