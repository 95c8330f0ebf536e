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
/// profile. Less than one sample and a half is explained as well by the holds of input and output.
/// Proven by tests/separation/identification/channel_delay_test.cc.
struct ElasticDelay {
  Estimate delay_s;
  Bvrm model;  // elastic, with the delay
};
/// Whatever its size, with the number of modes that the samples choose after the refinement;
/// nothing where the record is too short or no elastic model fits.
std::optional<ElasticDelay> elastic_delay(std::span<const Segment> segments,
                                          double sampling_rate_hz, const OutputErrorOptions& fit);
/// Nothing, too, when it is less than one sample and a half.
std::optional<Estimate> estimate_delay(std::span<const Segment> segments, double sampling_rate_hz,
                                       const OutputErrorOptions& fit);

}  // namespace vibrissa::separation
