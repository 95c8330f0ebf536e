#include "signals/formats/text/text_table.h"

#include <algorithm>

#include "signals/base/error.h"
#include "signals/base/utf_8.h"

namespace vibrissa::signals::formats {
namespace {

std::string shortened(const std::string_view text) {
  constexpr std::size_t most = 40;
  return as_utf_8(text.substr(0, most)) + (text.size() > most ? "..." : "");
}

// Only a decimal point is understood by TimeDigits.
void see_digits(const std::string_view field, const bool is_number, const char decimal,
                TimeDigits& digits) {
  if (!is_number) return digits.see(printed_seconds(field));
  if (decimal == '.') return digits.see(field);
  std::string text(field);
  for (char& c : text)
    if (c == ',') c = '.';
  digits.see(text);
}

}  // namespace

std::optional<TimeAxis> TextTable::clock() const {
  const auto& rate = file_.layout().rate;
  if (!rate) return {};
  return TimeAxis{rate->start_s, rate->rate_hz};
}

bool TextTable::clock_is_nominal() const {
  return !file_.layout().rate || !file_.layout().rate->is_exact;
}

std::vector<RateGroup> TextTable::rate_groups() const {
  std::vector<RateGroup> groups = file_.layout().rate_groups;
  if (!groups.empty() && file_.block_starts().size() > 1)
    throw UserError(file_.place(file_.line_of(file_.block_starts()[1])) +
                    "a further block begins, and the channels have different steps; export each "
                    "block, or each rate, to its own file");
  for (RateGroup& group : groups) group.n_rows = std::min(group.n_rows, n_rows());
  return groups;
}

void TextTable::refuse_field(const std::size_t line, const std::size_t column,
                             const std::string_view field) const {
  throw UserError(
      file_.place(line) + "column '" + file_.columns()[column] + "': " +
      (field.empty() ? "the field is empty" : "'" + shortened(field) + "' is not a number"));
}

ColumnValues TextTable::read(const ColumnRange& range) const {
  ColumnValues values{.columns = std::vector<std::vector<double>>(range.columns.size()),
                      .time_digits = {}};
  for (std::vector<double>& column : values.columns) column.reserve(range.n_rows);
  const char decimal = file_.layout().spelling.decimal;
  const auto read_row = [&](const std::size_t line,
                            const std::span<const std::string_view> fields) {
    std::optional<bool> time_is_number;
    for (std::size_t c = 0; c < range.columns.size(); ++c) {
      const std::string_view field = fields[range.columns[c]];
      std::optional<double> number = number_in(field, decimal);
      if (range.time_column == range.columns[c]) time_is_number = number.has_value();
      if (!number) number = time_in(field);
      if (!number) refuse_field(line, range.columns[c], field);
      values.columns[c].push_back(*number);
    }
    if (range.time_column) {
      const std::string_view field = fields[*range.time_column];
      if (!time_is_number) time_is_number = number_in(field, decimal).has_value();
      see_digits(field, *time_is_number, decimal, values.time_digits);
    }
  };
  file_.for_each_row(range.first_row, range.n_rows, read_row);
  return values;
}

std::string TextTable::text(const std::size_t row, const std::size_t column) const {
  std::string field;
  file_.for_each_row(row, 1, [&](std::size_t, const std::span<const std::string_view> fields) {
    field = shortened(fields[column]);
  });
  return field;
}

}  // namespace vibrissa::signals::formats
