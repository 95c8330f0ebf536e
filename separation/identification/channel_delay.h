#pragma once

#include <optional>
#include <span>

#include "separation/identification/output_error.h"
#include "separation/model/fitted_bvrm.h"
#include "separation/segments/aligned_segment.h"

namespace vibrissa::separation {

/// The time by which the moment is recorded later than the acceleration (negative: earlier) beyond
/// what a sensor with an elastic moment does. With free viscous terms every mode would take a delay
/// as a phase of its own; without them the phase belongs to the delay alone. Every whole number of
/// samples up to a quarter of Welch's segment, early and late, is tried on the frequency response
/// with one to three modes (vector fitting, gains by least squares); the smallest information
/// criterion is refined in time by the profile of the output error over the delay (explicit
/// time-delay parameter, Bjoerklund & Ljung 2003). Its deviation is from the curvature of that
/// profile. Nothing when it is less than one sample and a half: the holds of input and
/// output explain as much.
/// Proven by tests/separation/identification/channel_delay_test.cc.
std::optional<Estimate> estimate_delay(std::span<const Segment> segments, double sampling_rate_hz,
                                       const OutputErrorOptions& fit);

}  // namespace vibrissa::separation
