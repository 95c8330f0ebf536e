#pragma once

#include <filesystem>
#include <memory>

#include "signals/formats/record_table.h"
#include "signals/record/record.h"

namespace vibrissa::signals::formats {

/// The time responses of a file as columns: those that are as long and as finely sampled as the
/// first. A column is called by the first line of its function, or, where that says nothing or the
/// same for two, by the node and direction ("12+Z").
std::unique_ptr<RecordTable> read_uff58_table(const std::filesystem::path& file);

/// One time response a channel. The exact rate and start stand in its fourth line, for
/// read_uff58_table. Proven by tests/signals/formats/uff58_file_test.cc.
void write_uff58(const std::filesystem::path& file, const Record& record);

}  // namespace vibrissa::signals::formats
