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
  std::vector<ColumnChoice> columns = {};  // empty: the columns with the names of docs/records.md
  std::optional<double> sampling_rate_hz = {};  // needed when the file contains no time
  std::size_t first_row = 1;
  std::optional<std::size_t> n_rows = {};
  std::vector<std::string> remove_mean = {};  // channels whose mean is removed
};

/// Reads a record: CSV, or according to the ending of its name MATLAB, HDF5, NumPy, Universal File
/// type 58, WAV (formats/file_format.h). Without a choice of columns it reads all columns that are
/// known channels or end in a unit (hall_mT), with their own names, and ignores the others, such as
/// text. A rate that is given in addition to a time column must agree with it to 0.1 % and is used
/// then; without time the first row of the file is at 0 s. Only the chosen rows are checked. Proven
/// by tests/signals/files/record_io_test.cc, csv_file_test.cc and time_axis_test.cc. Throws
/// UserError with file, line and column for: a missing file or column, text that is not a number,
/// NaN or infinity, a gap in time, time that decreases, a repeated column name, rows of unequal
/// length, fewer than 64 samples, a rate that contradicts time_s, a missing channel in remove_mean.
Record read_record(const std::filesystem::path& file, const ReadOptions& options = {});

/// Writes the record in the format of the file's ending: .mat (MATLAB 5), .h5 or .hdf5, .npy, .uff,
/// .unv or .uf58 (values with 13 digits), else CSV with the shortest texts that read back to the
/// same double. The file is complete or does not exist. Throws UserError as write_file does, and
/// for .wav.
void write_record(const std::filesystem::path& file, const Record& record);

}  // namespace vibrissa::signals
