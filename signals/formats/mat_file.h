#pragma once

#include <filesystem>
#include <memory>

#include "signals/formats/numeric_table.h"
#include "signals/record.h"

namespace vibrissa::signals::formats {

enum class MatVersion { v5, v7_3 };

/// Every real array of a MATLAB file of any version, also within structs ("bench.ax"), as
/// columns_of makes columns of it. Throws UserError for a file that is damaged or claims more than
/// most_numbers.
std::unique_ptr<RecordTable> read_mat(const std::filesystem::path& file);

/// sampling_rate_hz, start_s, time_s and the channels as column vectors of doubles, to the last
/// bit. A record too long for version 5 (2 GiB a variable) is written as 7.3. Proven by
/// tests/signals/formats/round_trip_test.cc and tests/apps/exchange.py.
void write_mat(const std::filesystem::path& file, const Record& record,
               MatVersion version = MatVersion::v5);

}  // namespace vibrissa::signals::formats
