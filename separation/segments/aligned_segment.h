#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "separation/model/input_hold.h"
#include "separation/model/mode_step.h"

namespace vibrissa::separation {

/// A part of a record without interruption.
struct Segment {
  std::span<const double> base_acceleration;  // m/s^2
  std::span<const double> base_moment;        // N m, the same number of samples
};

/// A segment in which output[n] corresponds to the model output at the time (n - fraction) / rate;
/// node and midpoint are the input shaped for the hold, direct is the input of the direct term.
struct AlignedSegment {
  std::vector<double> node, midpoint, direct, output;
  std::size_t first = 0;  // first output that is known
};

/// Whether the outputs are between the samples of the shaped input.
bool lies_between(const SampledDelay& delay, Hold hold);

/// Aligns segments for a model with this delay. Throws UserError that begins with `who` for unequal
/// lengths or a value that is not finite.
std::vector<AlignedSegment> align_segments(std::span<const Segment> segments,
                                           const SampledDelay& delay, Hold hold,
                                           const std::string& who);

}  // namespace vibrissa::separation
