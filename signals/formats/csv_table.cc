#include "signals/formats/csv_table.h"

#include <cassert>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::signals::formats {
namespace {

std::string shortened(const std::string_view text) {
  constexpr std::size_t most = 40;
  return std::string(text.substr(0, most)) + (text.size() > most ? "..." : "");
}

}  // namespace

ColumnValues CsvTable::read(const ColumnRange& range) const {
  ColumnValues values{.columns = {range.columns.size(), std::vector<double>(range.n_rows)},
                      .time_digits = {}};
  std::size_t i = 0;
  const auto read_row = [&](const std::size_t line,
                            const std::span<const std::string_view> fields) {
    for (std::size_t c = 0; c < range.columns.size(); ++c) {
      const std::string_view field = fields[range.columns[c]];
      const std::optional<double> number = to_number(field);
      if (!number)
        throw UserError(
            file_.place(line) + "column '" + file_.columns()[range.columns[c]] + "': " +
            (field.empty() ? "the field is empty" : "'" + shortened(field) + "' is not a number"));
      values.columns[c][i] = *number;
    }
    if (range.time_column) values.time_digits.see(fields[*range.time_column]);
    ++i;
  };
  file_.for_each_row(range.first_row, range.n_rows, read_row);
  return values;
}

std::string CsvTable::text(const std::size_t row, const std::size_t column) const {
  std::string field;
  file_.for_each_row(row, 1, [&](std::size_t, const std::span<const std::string_view> fields) {
    field = shortened(fields[column]);
  });
  return field;
}

}  // namespace vibrissa::signals::formats
