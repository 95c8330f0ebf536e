#include "signals/formats/numeric_table.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "signals/base/error.h"
#include "signals/base/lower_case.h"
#include "signals/base/number_text.h"

namespace vibrissa::signals::formats {
namespace {

std::string last_part(const std::string& name) {
  return lower_case(name.substr(name.find_last_of("./") + 1));
}

constexpr auto rate_names = std::to_array<std::string_view>(
    {"sampling_rate_hz", "sample_rate", "fs", "samplerate", "sampling_rate", "samplingrate",
     "sample_rate_hz", "fs_hz", "samplingfrequency", "sampling_frequency", "abtastrate"});
constexpr auto period_names =
    std::to_array<std::string_view>({"dt", "ts", "dt_s", "ts_s", "sampling_interval",
                                     "sampling_period", "sampletime", "sample_time"});

// The rate that a scalar of this name gives.
std::optional<double> rate_of(const NumericColumn& scalar) {
  const std::string name = last_part(scalar.name);
  const double value = scalar.values.front();
  std::optional<double> rate;
  if (std::ranges::find(rate_names, name) != rate_names.end()) rate = value;
  if (std::ranges::find(period_names, name) != period_names.end()) rate = 1. / value;
  return rate && std::isfinite(*rate) && *rate > 0. ? rate : std::nullopt;
}

// The rate of "Time_Sample_Rate"; nothing where several differ.
std::optional<double> rate_of_longer_names(const std::vector<NumericColumn>& arrays) {
  std::optional<double> rate;
  for (const NumericColumn& array : arrays) {
    const std::string name = last_part(array.name);
    const bool ends_so = std::ranges::any_of(rate_names, [&](const std::string_view known) {
      return name.ends_with("_" + std::string(known));
    });
    if (array.values.size() != 1 || !ends_so) continue;
    const double value = array.values.front();
    if (!(std::isfinite(value) && value > 0.) || (rate && *rate != value)) return std::nullopt;
    rate = value;
  }
  return rate;
}

std::optional<TimeAxis> stated_clock(const std::string& file,
                                     const std::vector<NumericColumn>& arrays) {
  std::optional<double> rate, start;
  std::string name;
  for (const NumericColumn& array : arrays) {
    if (array.values.size() != 1) continue;
    if (array.name == "start_s") start = array.values.front();
    const auto found = rate_of(array);
    constexpr double same = 1e-6;
    if (found && rate && std::abs(*found / *rate - 1.) > same)
      throw UserError(file + ": '" + name + "' and '" + array.name + "' give different rates, " +
                      to_text(*rate) + " and " + to_text(*found) + " Hz; keep one");
    if (!found || rate) continue;
    rate = found;
    name = array.name;
  }
  if (!rate) rate = rate_of_longer_names(arrays);
  if (!rate) return std::nullopt;
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
    : file_(std::move(file)), clock_(clock ? clock : stated_clock(file_, arrays)) {
  const std::size_t length = usual_length(arrays);
  if (length == 0)
    throw UserError(file_ + ": contains no column of real numbers; a record needs such columns");
  std::set<std::string> known;
  for (NumericColumn& array : arrays) {
    if (array.values.size() <= 1) continue;
    if (!known.insert(array.name).second)
      throw UserError(file_ + ": two columns have the name '" + array.name + "'; rename one");
    others_.push_back(std::move(array));
  }
  take_length(length);
}

void NumericTable::take_length(const std::size_t length) {
  std::vector<NumericColumn> all = std::move(columns_);
  std::move(others_.begin(), others_.end(), std::back_inserter(all));
  columns_.clear();
  others_.clear();
  names_.clear();
  for (NumericColumn& array : all) {
    const bool is_column = array.values.size() == length;
    if (is_column) names_.push_back(array.name);
    (is_column ? columns_ : others_).push_back(std::move(array));
  }
}

void NumericTable::take_rows_of(const std::string& column) {
  for (const NumericColumn& other : others_)
    if (other.name == column) return take_length(other.values.size());
}

std::string NumericTable::layout_text() const {
  if (others_.empty()) return {};
  return std::to_string(columns_.size()) + " arrays of " + std::to_string(n_rows()) + " numbers; " +
         std::to_string(others_.size()) + " of other lengths are not used";
}

std::vector<std::string> NumericTable::other_columns() const {
  std::vector<std::string> names;
  for (const NumericColumn& other : others_) names.push_back(other.name);
  return names;
}

std::vector<std::string> NumericTable::units() const {
  std::vector<std::string> units;
  for (const NumericColumn& column : columns_) units.push_back(column.unit);
  return units;
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
