#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "signals/formats/numeric_table.h"
#include "signals/record/record.h"
#include "signals/spectra/frequency_response.h"

namespace vibrissa::signals::formats {

enum class MatVersion { v5, v7_3 };

/// Reads every array of a MATLAB file of any version, also within structs ("bench.ax"); columns_of
/// converts it to columns. A complex array gives NAME_real and NAME_imaginary. Throws UserError for
/// a file that is damaged or declares more than most_numbers.
std::unique_ptr<RecordTable> read_mat(const std::filesystem::path& file);

/// Writes sampling_rate_hz, start_s, time_s and the channels as column vectors of doubles, without
/// rounding. A record that is too long for version 5 (2 GiB for each variable) is written as
/// version 7.3. Proven by tests/signals/formats/round_trip_test.cc and tests/apps/exchange.py.
void write_mat(const std::filesystem::path& file, const Record& record,
               MatVersion version = MatVersion::v5);

/// Writes frequency_hz, response (complex), convention (text) and, when the response has them,
/// coherence and standard_deviation, in version 5; see response_file.h.
void write_mat(const std::filesystem::path& file, const FrequencyResponse& response,
               const std::string& convention);

}  // namespace vibrissa::signals::formats
