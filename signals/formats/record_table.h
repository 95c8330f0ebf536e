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

/// Columns of one rate in a file that has several.
struct RateGroup {
  std::vector<std::size_t> columns;
  TimeAxis clock{};
  std::size_t n_rows = 0;
};

/// Named columns of numbers of a file of any format.
class RecordTable {
 public:
  virtual ~RecordTable() = default;

  virtual const std::vector<std::string>& columns() const = 0;
  /// The unit that the file states for each column beside its name; empty where it states none.
  virtual std::vector<std::string> units() const {
    return std::vector<std::string>(columns().size());
  }
  /// Names of what the file holds beside these columns, in arrays of other lengths.
  virtual std::vector<std::string> other_columns() const { return {}; }
  virtual std::size_t n_rows() const = 0;
  /// Start of a message about a row, counted from 1, or (row 0) about the names of the columns:
  /// "<file>:<line>: " or "<file>: row 7: ".
  virtual std::string place(std::size_t row) const = 0;
  /// How messages name a row of the file: "<word> <number>".
  virtual std::string row_word() const { return "row"; }
  virtual std::size_t row_number(std::size_t row) const { return row; }
  /// The sampling rate and start that the file states in addition to its columns.
  virtual std::optional<TimeAxis> clock() const { return std::nullopt; }
  /// Whether that rate is only nominal, such as in a comment, so that time stamps are better.
  virtual bool clock_is_nominal() const { return false; }
  /// The columns by rate, where the file states several; empty: all columns have one.
  virtual std::vector<RateGroup> rate_groups() const { return {}; }
  /// First rows of the recordings in the file.
  virtual std::vector<std::size_t> block_starts() const { return {1}; }
  /// Takes the rows of this column where columns of several lengths are in the file.
  virtual void take_rows_of(const std::string& column) { static_cast<void>(column); }
  /// How the file is read, for the user: "semicolons, decimal commas, names in line 1".
  virtual std::string layout_text() const { return {}; }
  /// Throws UserError with the place of a text that is not a number.
  virtual ColumnValues read(const ColumnRange& range) const = 0;
  /// One value with the spelling of the file, for messages.
  virtual std::string text(std::size_t row, std::size_t column) const = 0;
};

}  // namespace vibrissa::signals::formats
