#pragma once

#include "signals/spectra/frequency_response.h"

namespace vibrissa::separation {

/// Whether the lines about a peak belong to an oscillation that grows: 1 / (j (w - w0) - d) about
/// w0 in place of 1 / (j (w - w0) + d), d > 0, each with complex gain and background. Through a
/// resonance of a stable sensor the phase falls; it rises where the peak is no answer to the base,
/// but a vibration of its own. True where the growing one is a hundred times as likely. For peaks
/// that are narrower than the lines. Proven by tests/separation/verdict/verdict_test.cc.
bool phase_rises(const signals::FrequencyResponse& response, double at_hz);

/// The frequency [Hz] of a peak from its amplitude alone: least squares of the amplitude of an
/// oscillator, for a peak whose phase tells nothing. The same where the lines about it are fewer
/// than half of those that are used, or not finite.
double amplitude_peak_hz(const signals::FrequencyResponse& response, double at_hz);

}  // namespace vibrissa::separation
