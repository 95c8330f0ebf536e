#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "signals/base/line_reader.h"
#include "signals/formats/text/table_layout.h"
#include "signals/formats/text/text_encoding.h"

namespace vibrissa::signals::formats {

/// A table in a text file. Its layout is recognised (table_layout.h) and holds for the whole file.
/// Blank lines, comments, repeated lines of names and the headers of further blocks are no rows.
/// Rows may lack last columns that are empty in the other rows. The reader does not interpret the
/// fields, so text in an unused column is allowed. The file is not kept in memory; each visit reads
/// it again. Only one thread may use an object at a time. Proven by
/// tests/signals/formats/text_file_test.cc.
class TextFile {
 public:
  /// Receives one row: its line in the file, counted from 1, and one field for each column; valid
  /// during the call.
  using RowReader = std::function<void(std::size_t line, std::span<const std::string_view> fields)>;

  /// Throws UserError for a file that cannot be read or is empty, and what find_layout throws.
  explicit TextFile(const std::filesystem::path& file, const TextOptions& options = {});

  const TableLayout& layout() const { return layout_; }
  const std::vector<std::string>& columns() const { return layout_.names; }
  std::size_t n_rows() const { return n_rows_; }
  /// The line of a row, both counted from 1; row 0 is the line with the names.
  std::size_t line_of(std::size_t row) const;
  /// First rows of the blocks of the file.
  const std::vector<std::size_t>& block_starts() const { return block_starts_; }

  /// Visits the rows first ... first + count - 1, counted from 1, and checks only them. Throws
  /// UserError with file and line for a row whose number of fields differs from the number of
  /// columns.
  void for_each_row(std::size_t first, std::size_t count, const RowReader& read) const;

  /// "<file>:<line>: ", the start of a message about that line; the first line is line 1.
  std::string place(std::size_t line) const;

 private:
  struct Place {
    std::size_t row = 1, at = 0;
    bool in_header = false;
  };
  bool next_row(LineReader& lines, std::string_view& line, Place& place) const;
  bool is_passed_over(std::string_view line, bool& in_header) const;
  bool is_without_values(std::string_view line) const;
  void index_rows();
  void fit_fields(std::size_t line, std::vector<std::string_view>& fields) const;
  [[noreturn]] void refuse_row(std::size_t line, std::size_t n_fields) const;

  std::string name_;
  OpenedText text_;
  TableLayout layout_;
  std::string line_of_names_;  // its text
  std::size_t n_rows_ = 0;
  std::size_t end_ = 0;  // end of the last row
  /// Rows that stand behind lines that are no rows: the row, and how many such lines are before it.
  std::vector<std::pair<std::size_t, std::size_t>> shifts_;
  std::vector<std::size_t> block_starts_ = {1};
  /// End of the last visit, so that consecutive parts need no new search.
  mutable Place last_;
};

}  // namespace vibrissa::signals::formats
