#pragma once

#include <span>
#include <vector>

#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// How much more noise a channel has at low frequencies than at high ones: density over that of the
/// upper half of the spectrum, 1 + excess / (1 + (f / corner)^2); or any course, in bands of equal
/// width from zero on, over that of the quietest.
struct NoiseColour {
  double excess = 0.;
  double corner_hz = 1.;
  std::vector<double> bands{};  // none: as excess and corner say
  double band_hz = 1.;
  double density(double frequency_hz) const;
  bool is_white() const { return excess == 0. && bands.empty(); }
};

/// One line of a spectrum that holds noise alone.
struct NoiseLine {
  double frequency_hz = 0.;
  double power = 0.;       // |X|^2 over the number of samples
  bool reference = false;  // of the upper half, to which densities are related
};

/// By Whittle's likelihood. White unless colour is far likelier, and likelier than a random walk:
/// that is an effect of its own. Lines that stand out (hum) count for nothing. corner_hz is 2 ..
/// 20, excess up to 20. Proven by tests/diagnosis/records/noise_colour_test.cc.
NoiseColour noise_colour(std::span<const NoiseLine> lines);

/// Of the moment in bands, from fit records that are moved by the base alone: what no response that
/// is smooth over a few lines makes of the acceleration (signals::local_polynomial_response). White
/// where no such record is so long that modes of this bandwidth are smooth. Proven by
/// tests/diagnosis/records/noise_colour_test.cc.
NoiseColour colour_beside_response(const signals::Dataset& dataset, double narrowest_mode_hz);

/// Of both channels, from fit records at rest (for the acceleration: with a still base); for the
/// moment also from what periods of a drive do not share, well below the first mode, and where
/// there is neither, colour_beside_response.
struct ChannelColours {
  NoiseColour moment, acceleration;
};
ChannelColours channel_colours(const signals::Dataset& dataset, double narrowest_mode_hz);

}  // namespace vibrissa::diagnosis
