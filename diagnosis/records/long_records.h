#pragma once

#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Records with at most this many samples are used completely. Longer records cost memory and time
/// without more information on any effect, except a drift, which needs the duration and not the
/// samples.
inline constexpr std::size_t longest_whole_record = std::size_t{1} << 17;

/// Replaces each longer record by four pieces with this many samples in total, spread from its
/// beginning to its end (whole periods of a periodic record), with the clock's time at their start.
/// An entry in guesses reports it. Proven by tests/diagnosis/records/long_records_test.cc.
signals::Dataset in_pieces(const signals::Dataset& dataset);

}  // namespace vibrissa::diagnosis
