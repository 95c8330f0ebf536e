#pragma once

#include <string>
#include <vector>

#include "signals/formats/record_table.h"

namespace vibrissa::signals::formats {

/// One column of a binary format.
struct NumericColumn {
  std::string name;
  std::vector<double> values;
  bool single_precision = false;  // the file stores values in single precision (24 bits)
  std::string unit = {};          // that the file states
};

/// Largest number of values that a file may contain or declare: 1 GiB of doubles. The declared size
/// of a damaged or hostile file is checked against it before memory is allocated.
inline constexpr std::size_t most_numbers = std::size_t{1} << 27;

/// Table of columns in memory. Proven by tests/signals/formats/numeric_table_test.cc.
class NumericTable : public RecordTable {
 public:
  /// The columns are the arrays of the most frequent length (the longer one when two lengths are
  /// equally frequent), or of the length of the column that take_rows_of() names. A scalar with the
  /// name sampling_rate_hz, fs, sample_rate or similar gives the sampling rate, dt or Ts its
  /// period, start_s the start; in a struct, too; without these a rate with more words before it,
  /// as Time_Sample_Rate, if all such agree. Throws UserError when there is no column, a name
  /// is repeated, or two scalars give different rates.
  NumericTable(std::string file, std::vector<NumericColumn> arrays,
               std::optional<TimeAxis> clock = {});

  const std::vector<std::string>& columns() const override { return names_; }
  std::vector<std::string> units() const override;
  std::vector<std::string> other_columns() const override;
  std::size_t n_rows() const override { return columns_.front().values.size(); }
  void take_rows_of(const std::string& column) override;
  std::string layout_text() const override;
  std::string place(std::size_t row) const override;
  std::optional<TimeAxis> clock() const override { return clock_; }
  ColumnValues read(const ColumnRange& range) const override;
  std::string text(std::size_t row, std::size_t column) const override;

 private:
  void take_length(std::size_t length);

  std::string file_;
  std::vector<NumericColumn> columns_, others_;
  std::vector<std::string> names_;
  std::optional<TimeAxis> clock_;
};

}  // namespace vibrissa::signals::formats
