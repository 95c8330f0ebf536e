#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "signals/time_axis.h"

namespace vibrissa::signals::formats {

/// Rows of some columns; rows count from 1.
struct ColumnRange {
  std::span<const std::size_t> columns;  // numbers in RecordTable::columns()
  std::size_t first_row = 1, n_rows = 0;
};

/// Named columns of numbers, as a file gives them, whatever its format.
class RecordTable {
 public:
  virtual ~RecordTable() = default;

  virtual const std::vector<std::string>& columns() const = 0;
  virtual std::size_t n_rows() const = 0;
  /// Start of a message about a row, counted from 1, or (row 0) about the names of the columns:
  /// "<file>:<line>: " or "<file>: row 7: ".
  virtual std::string place(std::size_t row) const = 0;
  /// How people find a row of the file: row r is "<word> <r + offset>".
  struct RowNames {
    std::string word = "row";
    std::size_t offset = 0;
  };
  virtual RowNames row_names() const { return {}; }
  /// The clock that the file states beside its columns.
  virtual std::optional<TimeAxis> clock() const { return std::nullopt; }
  /// Values of each column, which may be NaN or infinite. Throws UserError with the place of what
  /// is no number.
  virtual std::vector<std::vector<double>> read(const ColumnRange& range) const = 0;
  /// One value as the file spells it, for messages.
  virtual std::string text(std::size_t row, std::size_t column) const = 0;
  /// How finely the rows of one column are printed.
  virtual TimeDigits digits(const ColumnRange& one_column) const = 0;
};

/// Opens a file by the end of its name: .csv, .mat (5 and 7.3), .h5 and .hdf5, .npy, .uff, .unv and
/// .uf58 (type 58), .wav; any other is taken as CSV. Throws UserError for a file that cannot be
/// read, is damaged, or holds more than a record can. Proven by tests/signals/formats.
std::unique_ptr<RecordTable> open_table(const std::filesystem::path& file);

/// End of the name in lower case, with its point.
std::string extension_of(const std::filesystem::path& file);

}  // namespace vibrissa::signals::formats
