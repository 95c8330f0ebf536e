#pragma once

#include <span>

namespace vibrissa::separation {

/// Power and the standard deviation of its estimate, both [N^2 m^2].
struct CoherentPower {
  double value_n2_m2 = 0.;
  double deviation_n2_m2 = 0.;
};

/// The part of the power of a moment that is a linear response to the base acceleration: sum over
/// Welch's lines of (|H|^2 - sd^2) S_aa df, where H is the H1 response and sd^2 the power of its
/// error (times n / (n - 1) for n averages), so that a moment of another cause (wind, noise) adds
/// nothing on average; the value can be negative by chance. The deviation includes the correlation
/// of neighbouring lines by the Hann window. A segment has four seconds, or less so that eight
/// segments fit. The measure does not detect lost wind. Throws UserError for signals of unequal
/// length, values that are not finite, a constant base acceleration, or fewer than 64 samples.
/// Proven by tests/separation/metrics/coherent_power_test.cc.
CoherentPower coherent_power(std::span<const double> base_acceleration_m_s2,
                             std::span<const double> moment_n_m, double sampling_rate_hz);

}  // namespace vibrissa::separation
