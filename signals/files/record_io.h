#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "signals/files/column_choice.h"
#include "signals/record/record.h"

namespace vibrissa::signals {

/// How a record file is read. Rows are data rows, counted from 1 after the header line.
struct ReadOptions {
  std::vector<ColumnChoice> columns = {};       // empty: the columns of docs/records.md as named
  std::optional<double> sampling_rate_hz = {};  // needed when the file tells no time
  std::size_t first_row = 1;
  std::optional<std::size_t> n_rows = {};
  std::vector<std::string> remove_mean = {};  // channels whose mean is taken off
};

/// Reads a record: CSV, or by the end of its name MATLAB, HDF5, NumPy, Universal File type 58, WAV
/// (formats/file_format.h). Without a choice of columns it takes all that are known channels or end
/// in a unit (hall_mT) under their own names and leaves others, such as text, unread. A rate that
/// is given beside a column of time must agree to 0.1 % and is then the one taken; without time the
/// first row of the file is at 0 s. Only the chosen rows are checked. Proven by
/// tests/signals/files/record_io_test.cc, csv_file_test.cc and time_axis_test.cc. Throws UserError
/// with file, line and column for: a missing file or column, text that is no number, NaN or
/// infinity, a gap in time, time that runs backward, a repeated column name, rows of unequal
/// length, fewer than 64 samples, a rate that contradicts time_s, a channel without mean that is
/// not there.
Record read_record(const std::filesystem::path& file, const ReadOptions& options = {});

/// Writes the record by the end of the file's name: .mat (MATLAB 5), .h5 or .hdf5, .npy, .uff, .unv
/// or .uf58 (values with 13 digits), else CSV in the shortest form that reads back to the same
/// double. The file is whole or not there at all. Throws UserError as write_file does, and for
/// .wav.
void write_record(const std::filesystem::path& file, const Record& record);

}  // namespace vibrissa::signals
