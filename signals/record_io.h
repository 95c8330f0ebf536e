#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "signals/record.h"

namespace vibrissa::signals {

/// Takes a foreign column as one of our channels, or as time_s: value = scale * column.
struct ColumnChoice {
  std::string channel;  // full channel name with unit, e.g. "base_acceleration_m_s2"
  std::string column;   // as in the file's first line
  double scale = 1.;
};

/// Parses "base_acceleration=z_mps2" or "base_moment=hall_mT*1.8e-4". The channel may be given with
/// or without its unit. Throws UserError that lists the known channels, or for a
/// scale that is not a finite number other than 0.
ColumnChoice parse_column_choice(const std::string& text);

/// How a record file is read. Rows are data rows, counted from 1 after the header line.
struct ReadOptions {
  std::vector<ColumnChoice> columns = {};  // empty: the columns of records.md as they are named
  std::optional<double> sampling_rate_hz = {};  // needed when the file has no time_s column
  std::size_t first_row = 1;
  std::optional<std::size_t> n_rows = {};
};

/// Reads a CSV record. Without a choice of columns it takes all that are known channels or end in a
/// unit (hall_mT) under their own names and leaves others, such as text, unread. A rate that is
/// given beside a column of time must agree to 0.1 % and is then the one taken; without time the
/// first row of the file is at 0 s. Only the chosen rows are checked. Proven by
/// tests/signals/record_io_test.cc, csv_file_test.cc and time_axis_test.cc. Throws UserError with
/// file, line and column for: a missing file or column, text that is no number, NaN or infinity, a
/// gap in time, time that runs backward, a repeated column name, rows of unequal length, fewer than
/// 64 samples, a rate that contradicts time_s.
Record read_record(const std::filesystem::path& file, const ReadOptions& options = {});

/// Writes time_s and every channel with 17 significant digits where needed (shortest form that
/// reads back to the same double); to a temporary name in the same folder first, then renamed.
void write_record(const std::filesystem::path& file, const Record& record);

}  // namespace vibrissa::signals
