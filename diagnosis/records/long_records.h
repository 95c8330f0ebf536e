#pragma once

#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Records of at most this many samples are used whole; a longer one costs memory and time without
/// saying more about any effect but a drift, which needs the span, not the samples.
inline constexpr std::size_t longest_whole_record = std::size_t{1} << 17;

/// Each longer record as four pieces that have as many samples in all, spread from its
/// beginning to its end, whole periods of a periodic one, with the clock's time at their start; a
/// guess says so. Proven by tests/diagnosis/records/long_records_test.cc.
signals::Dataset in_pieces(const signals::Dataset& dataset);

}  // namespace vibrissa::diagnosis
