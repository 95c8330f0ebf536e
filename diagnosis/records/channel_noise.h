#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "diagnosis/model/nominal_model.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Number of whole periods of a record; 1 where it is not periodic or its length is not a multiple.
std::size_t n_periods(const signals::DatasetRecord& entry);

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
/// tests/diagnosis/records/channel_noise_test.cc.
NoiseLines noise_lines(std::span<const double> reading, double rate_hz, bool moves);

/// Usual accelerometer noise (ADXL345 at rest), standard deviation per sample [m/s^2];
/// docs/theory.md (T15) gives 0.008 g as an upper bound.
inline constexpr double usual_acceleration_noise = 0.05;

/// Noise standard deviations per sample of both channels, from records at rest and from differences
/// between periods; otherwise from the quietest part of the spectrum, which is an upper bound (for
/// the acceleration at most the usual noise where no part is quiet). Proven by
/// tests/diagnosis/records/experiment_test.cc.
struct ChannelNoise {
  double moment_n_m = 0., acceleration_m_s2 = 0.;
  bool acceleration_is_measured = false;  // at rest or from repeats
};
ChannelNoise channel_noise(const signals::Dataset& dataset);

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
