#pragma once

#include <optional>
#include <string>

#include "signals/files/record_io.h"
#include "signals/spectra/clock_relation.h"

namespace vibrissa::signals {

/// What becomes of the channels of the slower device, whose times are kept. The filter of the
/// faster one makes a resonance of its own in a response between them, unless both pass it.
enum class SlowerDevice { filtered_alike, as_recorded };

/// The channels of two recordings on one clock, at the sampling times of the slower device. All
/// are low-passed alike (flat to 0.38 of the lower rate) and taken at these times by a windowed
/// sinc, which needs 32 samples before and behind. Each device has the rate of its own stamps, so
/// drift between them is followed; their zeros are those of the stamps. Throws UserError for a
/// channel in both, for dates in one file only, and where they do not overlap. Proven by
/// tests/signals/files/joined_recording_test.cc.
Recording joined(const Recording& one, const Recording& other);

/// The same with the clocks as told, not as the stamps have them; of a channel in both, that of
/// `one` is taken. Nothing is required of the stamps.
Recording joined(const Recording& one, const Recording& other, const ClockRelation& clocks,
                 SlowerDevice slower = SlowerDevice::filtered_alike);

/// The channel that both have and that tells their clocks: an acceleration before others.
std::optional<std::string> shared_channel(const Recording& one, const Recording& other);

/// relate_clocks of a channel in the longest piece of each.
ClockRelation clocks_of(const Recording& one, const std::string& channel_of_one,
                        const Recording& other, const std::string& channel_of_other,
                        SharedMotion shared);

/// "time 0 of the second file is at 12.3456 s (± 0.00002 s) of the first, and its clock runs 57.3 ±
/// 0.2 ppm slow".
std::string clock_words(const ClockRelation& clocks);

}  // namespace vibrissa::signals
