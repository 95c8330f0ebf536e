#pragma once

#include <filesystem>
#include <memory>

#include "signals/formats/numeric_table.h"
#include "signals/record/record.h"

namespace vibrissa::signals::formats {

/// Reads every array of real numbers with its path as name ("bench/ax"); columns_of converts it to
/// columns. Throws UserError for a file that is damaged or declares more than most_numbers.
std::unique_ptr<RecordTable> read_hdf5(const std::filesystem::path& file);

/// Writes time_s, sampling_rate_hz, start_s and the channels as top-level arrays of doubles,
/// without rounding; the attribute "conventions" describes them. Proven by
/// tests/signals/formats/round_trip_test.cc, tests/apps/exchange.py.
void write_hdf5(const std::filesystem::path& file, const Record& record);

}  // namespace vibrissa::signals::formats
