#pragma once

#include <filesystem>
#include <memory>

#include "signals/formats/numeric_table.h"
#include "signals/record/record.h"

namespace vibrissa::signals::formats {

/// A NumPy array file (NEP 1, versions 1 to 3): a vector or matrix of reals, whose columns are
/// column_1, column_2 and so on, or a vector of a structured type, whose fields are the columns.
/// Throws UserError for another file, another type, and a size that is not the file's.
std::unique_ptr<RecordTable> read_npy(const std::filesystem::path& file);
/// The same from its bytes; name stands for the file in messages.
std::unique_ptr<RecordTable> parse_npy(const std::string& bytes, const std::string& name);

/// A vector of a structured type: time_s and the channels, doubles to the last bit. Its format has
/// no room for the clock, which is read from time_s.
/// Proven by tests/signals/formats/round_trip_test.cc, tests/apps/exchange.py.
void write_npy(const std::filesystem::path& file, const Record& record);

}  // namespace vibrissa::signals::formats
