#pragma once

#include "signals/formats/record_table.h"

namespace vibrissa::signals {

/// The columns of one rate of a table that has several. The table must outlive it. Proven by
/// tests/signals/formats/labview_file_test.cc.
class OneRateTable : public formats::RecordTable {
 public:
  OneRateTable(const formats::RecordTable& table, formats::RateGroup group);

  const std::vector<std::string>& columns() const override { return names_; }
  std::vector<std::string> units() const override;
  std::size_t n_rows() const override { return group_.n_rows; }
  std::string place(std::size_t row) const override { return table_.place(row); }
  std::string row_word() const override { return table_.row_word(); }
  std::size_t row_number(std::size_t row) const override { return table_.row_number(row); }
  std::optional<TimeAxis> clock() const override { return group_.clock; }
  formats::ColumnValues read(const formats::ColumnRange& range) const override;
  std::string text(std::size_t row, std::size_t column) const override;

 private:
  const formats::RecordTable& table_;
  formats::RateGroup group_;
  std::vector<std::string> names_;
};

}  // namespace vibrissa::signals
