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

/// A comma-separated text file: column names in the first line, then one row in each line. Lines
/// that start with # before the names are comments; when numbers follow the comments directly, the
/// last comment with the same number of fields contains the names. The reader accepts Unix and
/// Windows line ends, a UTF-8 byte order mark, blank lines at the end, spaces around fields, and
/// fields in quotes (which may contain commas, but no line breaks). It does not interpret the
/// fields, so text in an unused column is allowed. The file is not kept in memory; each visit reads
/// it again. Only one thread may use an object at a time. Proven by
/// tests/signals/formats/csv_file_test.cc.
class CsvFile {
 public:
  /// Receives one row: its line in the file, counted from 1, and one field for each column; valid
  /// during the call.
  using RowReader = std::function<void(std::size_t line, std::span<const std::string_view> fields)>;

  /// Throws UserError for a file that cannot be read or is empty, a first line with numbers or
  /// other separators, and a repeated name.
  explicit CsvFile(const std::filesystem::path& file);

  const std::vector<std::string>& columns() const { return columns_; }
  std::size_t n_rows() const { return n_rows_; }
  /// The line of a row, both counted from 1; row 0 is the line with the names.
  std::size_t line_of(std::size_t row) const { return line_of_names_ + row; }
  bool has(const std::string& column) const;
  /// Throws UserError that lists the available columns.
  std::size_t index_of(const std::string& column) const;

  /// Visits the rows first ... first + count - 1, counted from 1, and checks only them. Throws
  /// UserError with file and line for a row whose number of fields differs from the number of
  /// columns.
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
  std::size_t end_ = 0;  // end of the last row
  /// End of the last visit, so that consecutive parts need no new search.
  mutable Place last_;
  std::vector<std::string> columns_;
};

}  // namespace vibrissa::signals
