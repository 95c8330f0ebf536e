#pragma once

#include "signals/formats/record_table.h"
#include "signals/formats/text/text_file.h"

namespace vibrissa::signals::formats {

/// A text file as a table: fields are converted to numbers, and dates and times to seconds, when
/// they are read. Proven by tests/signals/files/record_io_test.cc.
class TextTable : public RecordTable {
 public:
  explicit TextTable(const std::filesystem::path& file, const TextOptions& options = {})
      : file_(file, options) {}

  const std::vector<std::string>& columns() const override { return file_.columns(); }
  std::vector<std::string> units() const override { return file_.layout().units; }
  std::size_t n_rows() const override { return file_.n_rows(); }
  std::string place(std::size_t row) const override { return file_.place(file_.line_of(row)); }
  std::string row_word() const override { return "line"; }
  std::size_t row_number(std::size_t row) const override { return file_.line_of(row); }
  std::optional<TimeAxis> clock() const override;
  bool clock_is_nominal() const override;
  std::vector<RateGroup> rate_groups() const override;
  std::vector<std::size_t> block_starts() const override { return file_.block_starts(); }
  std::string layout_text() const override { return to_string(file_.layout()); }
  ColumnValues read(const ColumnRange& range) const override;
  std::string text(std::size_t row, std::size_t column) const override;

 private:
  [[noreturn]] void refuse_field(std::size_t line, std::size_t column,
                                 std::string_view field) const;

  TextFile file_;
};

}  // namespace vibrissa::signals::formats
