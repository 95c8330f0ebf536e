#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>

#include "signals/record/record.h"
#include "signals/record/time_axis.h"

namespace vibrissa::signals::formats {

/// Writes time_s and every channel, with the shortest texts that read back to the same double.
/// Proven by tests/signals/files/record_io_test.cc.
void write_csv(const std::filesystem::path& file, const Record& record);

/// The same block by block: first the names, then the rows of each block; first_sample is the
/// number of its first sample in the whole record.
void write_csv_header(std::ostream& out, const Record& block);
void write_csv_rows(std::ostream& out, const Record& block, const TimeAxis& axis,
                    std::size_t first_sample);

}  // namespace vibrissa::signals::formats
