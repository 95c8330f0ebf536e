#pragma once

#include <filesystem>
#include <memory>

#include "signals/formats/record_table.h"
#include "signals/record/record.h"

namespace vibrissa::signals::formats {

/// Reads the time responses of a file as columns: those with the length and the sampling interval
/// of the first one. The name of a column is the first line of its function or, when this line is
/// empty or not unique, node and direction ("12+Z").
std::unique_ptr<RecordTable> read_uff58_table(const std::filesystem::path& file);

/// Writes one time response for each channel. The fourth line contains the exact rate and start for
/// read_uff58_table. Proven by tests/signals/formats/uff58_file_test.cc.
void write_uff58(const std::filesystem::path& file, const Record& record);

}  // namespace vibrissa::signals::formats
