#pragma once

#include <filesystem>
#include <memory>

#include "signals/formats/numeric_table.h"
#include "signals/record/record.h"

namespace vibrissa::signals::formats {

/// Every array of real numbers, under its path ("bench/ax"), as columns_of makes columns of it.
/// Throws UserError for a file that is damaged or claims more than most_numbers.
std::unique_ptr<RecordTable> read_hdf5(const std::filesystem::path& file);

/// time_s, sampling_rate_hz, start_s and the channels as arrays of doubles at the top, to the last
/// bit; the attribute "conventions" says in words what they are.
/// Proven by tests/signals/formats/round_trip_test.cc, tests/apps/exchange.py.
void write_hdf5(const std::filesystem::path& file, const Record& record);

}  // namespace vibrissa::signals::formats
