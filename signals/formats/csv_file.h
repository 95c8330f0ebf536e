#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "signals/base/line_reader.h"

namespace vibrissa::signals {

/// A comma-separated text file: column names in its first line, then one row a line. Lines that
/// start with # before them are comments; where numbers follow, the last of these with as many
/// fields holds the names. Takes Unix and Windows line ends, a UTF-8 byte order mark, blank lines
/// at the end, spaces around fields and fields in quotes (which may hold commas, not line breaks).
/// What the fields mean is not its affair, so text in a column that nobody reads does no harm. The
/// file is not held in memory but read again for each visit. Not for use by several threads at a
/// time. Proven by tests/signals/formats/csv_file_test.cc.
class CsvFile {
 public:
  /// One row: its line in the file, counted from 1, and one field a column; valid during the call.
  using RowReader = std::function<void(std::size_t line, std::span<const std::string_view> fields)>;

  /// Throws UserError for a file that cannot be read or is empty, a first line that holds numbers
  /// or other separators, a name that is repeated.
  explicit CsvFile(const std::filesystem::path& file);

  const std::vector<std::string>& columns() const { return columns_; }
  std::size_t n_rows() const { return n_rows_; }
  /// The line that row is in, both counted from 1; of row 0 that with the names.
  std::size_t line_of(std::size_t row) const { return line_of_names_ + row; }
  bool has(const std::string& column) const;
  /// Throws UserError that lists the columns there are.
  std::size_t index_of(const std::string& column) const;

  /// Visits rows first ... first + count - 1, counted from 1; others are not looked at. Throws
  /// UserError with file and line for a row whose number of fields is not the number of columns.
  void for_each_row(std::size_t first, std::size_t count, const RowReader& read) const;

  /// "<file>:<line>: ", the start of a message about that line; the first line is line 1.
  std::string place(std::size_t line) const;

 private:
  void find_names(std::size_t start);
  void read_names(std::string_view line);
  [[noreturn]] void refuse_row(std::size_t line, std::size_t n_fields) const;

  void find_end();
  bool is_blank_from(std::size_t start) const;

  struct Place {
    std::size_t row = 1, at = 0;
  };
  std::string name_;
  FileBytes bytes_;
  std::size_t line_of_names_ = 1, first_row_at_ = 0, n_rows_ = 0;
  std::size_t end_ = 0;  // behind the last row
  /// Where the last visit ended, so that one part after the other is not searched for anew.
  mutable Place last_;
  std::vector<std::string> columns_;
};

}  // namespace vibrissa::signals
