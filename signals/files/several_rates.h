#pragma once

#include <string>

#include "signals/files/record_io.h"

namespace vibrissa::signals {

/// A table whose columns have several rates (RecordTable::rate_groups): the wanted channels of each
/// rate as a recording, all of them joined at the slowest rate of these (joined_recording.h). Rates
/// without a wanted channel are not read. Throws UserError as read_recording does, and for options
/// that mean one rate: rows and a rate. Proven by tests/signals/formats/labview_file_test.cc.
Recording read_several_rates(const formats::RecordTable& table, const std::string& name,
                             const ReadOptions& options);

}  // namespace vibrissa::signals
