#pragma once

#include <string>

#include "signals/files/record_io.h"

namespace vibrissa::signals {

/// The channels of two recordings on one clock, at the sampling times of the slower device. Its
/// samples are kept; those of the faster one are low-passed (flat to 0.38 of the lower rate) and
/// taken at these times by a windowed sinc, which needs 32 samples before and behind. Each device
/// has the rate of its own stamps, so drift between them is followed; their zeros are those of the
/// stamps. Throws UserError for a channel in both, for dates in one file only, and where they do
/// not overlap. Proven by tests/signals/files/joined_recording_test.cc.
Recording joined(const Recording& one, const Recording& other);

}  // namespace vibrissa::signals
