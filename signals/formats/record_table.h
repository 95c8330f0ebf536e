#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "signals/record/time_axis.h"

namespace vibrissa::signals::formats {

/// Rows of some columns; rows count from 1.
struct ColumnRange {
  std::span<const std::size_t> columns;  // numbers in RecordTable::columns()
  std::size_t first_row = 1, n_rows = 0;
  std::optional<std::size_t> time_column = {};  // the column whose printed digits are evaluated
};

struct ColumnValues {
  std::vector<std::vector<double>>
      columns;             // the requested columns; they may contain NaN and infinity
  TimeDigits time_digits;  // resolution of the printed time column
};

/// Named columns of numbers of a file of any format.
class RecordTable {
 public:
  virtual ~RecordTable() = default;

  virtual const std::vector<std::string>& columns() const = 0;
  virtual std::size_t n_rows() const = 0;
  /// Start of a message about a row, counted from 1, or (row 0) about the names of the columns:
  /// "<file>:<line>: " or "<file>: row 7: ".
  virtual std::string place(std::size_t row) const = 0;
  /// How messages name a row of the file: row r is "<word> <r + offset>".
  struct RowNames {
    std::string word = "row";
    std::size_t offset = 0;
  };
  virtual RowNames row_names() const { return {}; }
  /// The sampling rate and start that the file states in addition to its columns.
  virtual std::optional<TimeAxis> clock() const { return std::nullopt; }
  /// Throws UserError with the place of a text that is not a number.
  virtual ColumnValues read(const ColumnRange& range) const = 0;
  /// One value with the spelling of the file, for messages.
  virtual std::string text(std::size_t row, std::size_t column) const = 0;
};

}  // namespace vibrissa::signals::formats
