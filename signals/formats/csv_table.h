#pragma once

#include "signals/formats/csv_file.h"
#include "signals/formats/record_table.h"

namespace vibrissa::signals::formats {

/// A CSV file as a table: fields are converted to numbers when they are read. Proven by
/// tests/signals/files/record_io_test.cc.
class CsvTable : public RecordTable {
 public:
  explicit CsvTable(const std::filesystem::path& file) : file_(file) {}

  const std::vector<std::string>& columns() const override { return file_.columns(); }
  std::size_t n_rows() const override { return file_.n_rows(); }
  std::string place(std::size_t row) const override { return file_.place(file_.line_of(row)); }
  RowNames row_names() const override { return {"line", file_.line_of(0)}; }
  ColumnValues read(const ColumnRange& range) const override;
  std::string text(std::size_t row, std::size_t column) const override;

 private:
  CsvFile file_;
};

}  // namespace vibrissa::signals::formats
