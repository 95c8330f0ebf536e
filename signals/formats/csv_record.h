#pragma once

#include <filesystem>

#include "signals/record.h"

namespace vibrissa::signals::formats {

/// time_s and every channel, numbers in the shortest form that reads back to the same double.
/// Proven by tests/signals/record_io_test.cc.
void write_csv(const std::filesystem::path& file, const Record& record);

}  // namespace vibrissa::signals::formats
