#pragma once

#include <string>
#include <vector>

#include "signals/formats/record_table.h"

namespace vibrissa::signals::formats {

/// One column as binary formats hold it.
struct NumericColumn {
  std::string name;
  std::vector<double> values;
  bool single_precision = false;  // the file has 24 binary digits of each value
};

/// Most numbers that a file may hold or claim: 1 GiB of doubles. What a damaged or hostile file
/// says of its size is checked against it before memory is asked for.
inline constexpr std::size_t most_numbers = std::size_t{1} << 27;

/// Columns that are in memory. Proven by tests/signals/formats/numeric_table_test.cc.
class NumericTable : public RecordTable {
 public:
  /// Arrays of one file are its columns when they are equally long. Of several lengths the one that
  /// most arrays have is taken (the longer of two as frequent), the others are left out; a scalar
  /// named sampling_rate_hz, fs, Fs or sample_rate is the clock's rate, start_s its start. Throws
  /// UserError when nothing is left, or a name is repeated.
  NumericTable(std::string file, std::vector<NumericColumn> arrays,
               std::optional<TimeAxis> clock = {});

  const std::vector<std::string>& columns() const override { return names_; }
  std::size_t n_rows() const override { return columns_.front().values.size(); }
  std::string place(std::size_t row) const override;
  std::optional<TimeAxis> clock() const override { return clock_; }
  ColumnValues read(const ColumnRange& range) const override;
  std::string text(std::size_t row, std::size_t column) const override;

 private:
  std::string file_;
  std::vector<NumericColumn> columns_;
  std::vector<std::string> names_;
  std::optional<TimeAxis> clock_;
};

}  // namespace vibrissa::signals::formats
