#pragma once

#include <span>

#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Noise density of a channel relative to that of the upper half of the spectrum, 1 + excess / (1 +
/// (f / corner)^2).
struct NoiseColour {
  double excess = 0.;
  double corner_hz = 1.;
  double density(double frequency_hz) const;
  bool is_white() const { return excess == 0.; }
};

/// One line of a noise spectrum.
struct NoiseLine {
  double frequency_hz = 0.;
  double power = 0.;       // |X|^2 divided by the number of samples
  bool reference = false;  // belongs to the upper half of the spectrum, the reference of densities
};

/// Estimate by Whittle's likelihood. The noise is white unless colour is far more probable, also
/// than a random walk (which is an effect of its own). Tones (hum) are ignored. corner_hz is 2 ..
/// 20, excess up to 20. Proven by tests/diagnosis/records/noise_colour_test.cc.
NoiseColour noise_colour(std::span<const NoiseLine> lines);

/// Noise colour of both channels, from fit records at rest (for the acceleration: with the base at
/// rest); for the moment also from differences between periods well below the first mode. Proven by
/// tests/diagnosis/records/noise_colour_test.cc.
struct ChannelColours {
  NoiseColour moment, acceleration;
};
ChannelColours channel_colours(const signals::Dataset& dataset);

}  // namespace vibrissa::diagnosis
