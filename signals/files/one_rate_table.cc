#include "signals/files/one_rate_table.h"

#include <utility>

namespace vibrissa::signals {

OneRateTable::OneRateTable(const formats::RecordTable& table, formats::RateGroup group)
    : table_(table), group_(std::move(group)) {
  for (const std::size_t column : group_.columns) names_.push_back(table_.columns()[column]);
}

std::vector<std::string> OneRateTable::units() const {
  const std::vector<std::string> all = table_.units();
  std::vector<std::string> units;
  for (const std::size_t column : group_.columns) units.push_back(all[column]);
  return units;
}

formats::ColumnValues OneRateTable::read(const formats::ColumnRange& range) const {
  std::vector<std::size_t> columns;
  for (const std::size_t column : range.columns) columns.push_back(group_.columns[column]);
  formats::ColumnRange inner{columns, range.first_row, range.n_rows, {}};
  if (range.time_column) inner.time_column = group_.columns[*range.time_column];
  return table_.read(inner);
}

std::string OneRateTable::text(const std::size_t row, const std::size_t column) const {
  return table_.text(row, group_.columns[column]);
}

}  // namespace vibrissa::signals
