#pragma once

#include <span>

namespace vibrissa::separation {

/// Power with the standard deviation of its estimate, both [N^2 m^2].
struct CoherentPower {
  double value_n2_m2 = 0.;
  double deviation_n2_m2 = 0.;
};

/// The part of a moment's power that goes with the base acceleration by a linear response:
/// sum over Welch's lines of (|H|^2 - sd^2) S_aa df, where H is the H1 response and sd^2 the power
/// of its error (times n / (n - 1) for n averages), so that the moment of something else (wind,
/// noise) adds nothing on average; the value can be negative by chance. The deviation counts that a
/// Hann window ties neighbouring lines. Segments are of four seconds, or shorter so that eight fit.
/// Blind to wind that an estimate has lost. Throws UserError for signals of unequal length, values
/// that are not finite, a constant base acceleration, or fewer than 64 samples. Proven by
/// tests/separation/metrics/coherent_power_test.cc.
CoherentPower coherent_power(std::span<const double> base_acceleration_m_s2,
                             std::span<const double> moment_n_m, double sampling_rate_hz);

}  // namespace vibrissa::separation
