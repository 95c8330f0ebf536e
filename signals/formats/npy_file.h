#pragma once

#include <filesystem>
#include <memory>

#include "signals/formats/numeric_table.h"
#include "signals/record/record.h"

namespace vibrissa::signals::formats {

/// Reads a NumPy array file (NEP 1, versions 1 to 3): a vector or matrix of real numbers with the
/// columns column_1, column_2 and so on, or a vector of a structured type, whose fields are the
/// columns. Throws UserError for another file type, another number type, and a declared size that
/// differs from the size of the file.
std::unique_ptr<RecordTable> read_npy(const std::filesystem::path& file);
/// The same from the bytes of a file; name is the file name in messages.
std::unique_ptr<RecordTable> parse_npy(const std::string& bytes, const std::string& name);

/// Writes a vector of a structured type: time_s and the channels as doubles, without rounding. The
/// format cannot store the sampling rate; it is read from time_s. Proven by
/// tests/signals/formats/round_trip_test.cc, tests/apps/exchange.py.
void write_npy(const std::filesystem::path& file, const Record& record);

}  // namespace vibrissa::signals::formats
