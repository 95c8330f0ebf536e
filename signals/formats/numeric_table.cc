#include "signals/formats/numeric_table.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::signals::formats {
namespace {

bool is_rate(const std::string& name) {
  static const std::set<std::string_view> names{"sampling_rate_hz", "sample_rate", "fs", "Fs"};
  return names.count(name) != 0;
}

std::optional<TimeAxis> stated_clock(const std::vector<NumericColumn>& arrays) {
  std::optional<double> rate, start;
  for (const NumericColumn& array : arrays) {
    if (array.values.size() != 1) continue;
    if (is_rate(array.name)) rate = array.values.front();
    if (array.name == "start_s") start = array.values.front();
  }
  if (!rate || !(std::isfinite(*rate) && *rate > 0.)) return std::nullopt;
  return TimeAxis{start.value_or(0.), *rate};
}

std::string shortest_text(const float value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::size_t usual_length(const std::vector<NumericColumn>& arrays) {
  std::map<std::size_t, std::size_t> counts;
  for (const NumericColumn& array : arrays)
    if (array.values.size() > 1) ++counts[array.values.size()];
  std::pair<std::size_t, std::size_t> most{0, 0};  // count, length
  for (const auto& [length, count] : counts) most = std::max(most, std::pair(count, length));
  return most.second;
}

}  // namespace

NumericTable::NumericTable(std::string file, std::vector<NumericColumn> arrays,
                           std::optional<TimeAxis> clock)
    : file_(std::move(file)), clock_(clock ? clock : stated_clock(arrays)) {
  const std::size_t length = usual_length(arrays);
  if (length == 0)
    throw UserError(file_ + ": contains no column of real numbers; a record needs such columns");
  std::set<std::string> known;
  for (NumericColumn& array : arrays) {
    if (array.values.size() != length) continue;
    if (!known.insert(array.name).second)
      throw UserError(file_ + ": two columns have the name '" + array.name + "'; rename one");
    names_.push_back(array.name);
    columns_.push_back(std::move(array));
  }
}

std::string NumericTable::place(const std::size_t row) const {
  return row == 0 ? file_ + ": " : file_ + ": row " + std::to_string(row) + ": ";
}

ColumnValues NumericTable::read(const ColumnRange& range) const {
  assert(range.first_row >= 1 && range.first_row - 1 + range.n_rows <= n_rows());
  ColumnValues values;
  for (const std::size_t column : range.columns) {
    const auto first = columns_[column].values.begin() + std::ptrdiff_t(range.first_row - 1);
    values.columns.emplace_back(first, first + std::ptrdiff_t(range.n_rows));
  }
  for (std::size_t i = 0; range.time_column && i < range.n_rows; ++i)
    values.time_digits.see(text(range.first_row + i, *range.time_column));
  return values;
}

std::string NumericTable::text(const std::size_t row, const std::size_t column) const {
  const double value = columns_[column].values[row - 1];
  return columns_[column].single_precision ? shortest_text(static_cast<float>(value))
                                           : to_text(value);
}

}  // namespace vibrissa::signals::formats
