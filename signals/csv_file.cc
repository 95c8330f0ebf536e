#include "signals/csv_file.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <system_error>

#include "signals/error.h"
#include "signals/number_text.h"
#include "signals/trimmed.h"

namespace vibrissa::signals {
namespace {

FileBytes open_bytes(const std::filesystem::path& file) {
  if (std::error_code ignored; std::filesystem::is_directory(file, ignored))
    throw UserError(file.string() + ": this is a folder, not a CSV file");
  return FileBytes(file);
}

constexpr std::size_t everything = std::numeric_limits<std::size_t>::max();
constexpr const char* blanks = " \t\r\n";

// Where the field that starts at `at` ends: its comma, or the end of the line. Quotes hide commas
// only in a field that starts with one.
std::size_t field_end(const std::string_view line, const std::size_t at) {
  const auto start = line.find_first_not_of(" \t", at);
  if (start == std::string_view::npos || line[start] != '"')
    return std::min(line.find(',', at), line.size());
  bool quoted = true;
  std::size_t end = start + 1;
  for (; end < line.size() && (quoted || line[end] != ','); ++end)
    if (line[end] == '"') quoted = !quoted;
  return end;
}

void split_fields(const std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (std::size_t at = 0;;) {
    const std::size_t end = field_end(line, at);
    std::string_view field = trimmed(line.substr(at, end - at));
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
      field = trimmed(field.substr(1, field.size() - 2));
    fields.push_back(field);
    if (end == line.size()) return;
    at = end + 1;
  }
}

std::string without_doubled_quotes(const std::string_view name) {
  std::string result;
  for (std::size_t i = 0; i < name.size(); ++i) {
    result += name[i];
    if (name.substr(i).starts_with("\"\"")) ++i;
  }
  return result;
}

}  // namespace

CsvFile::CsvFile(const std::filesystem::path& file)
    : name_(file.string()), bytes_(open_bytes(file)) {
  const std::string_view byte_order_mark = "\xEF\xBB\xBF";
  std::string mark(byte_order_mark.size(), ' ');
  bytes_.read(0, mark.data(), mark.size());
  const std::size_t start = mark == byte_order_mark ? byte_order_mark.size() : 0;
  find_end(start);
  if (end_ <= start) throw UserError(name_ + ": the file is empty");
  LineReader lines(bytes_, start, end_);
  std::string_view header;
  lines.next(header);
  read_header(header);
  first_row_at_ = lines.position();
  last_ = {1, first_row_at_};
}

// Blank lines at the end are none.
void CsvFile::find_end(const std::size_t start) {
  LineReader lines(bytes_, start, everything);
  std::size_t n_lines = 0;
  end_ = start;
  std::size_t at = lines.position();
  for (std::string_view line; lines.next(line); at = lines.position()) {
    ++n_lines;
    const auto last = line.find_last_not_of(blanks);
    if (last == std::string_view::npos) continue;
    end_ = at + last + 1;
    n_rows_ = n_lines - 1;
  }
}

void CsvFile::read_header(const std::string_view line) {
  if (trimmed(line).empty())
    throw UserError(place(1) + "the first line is blank; it must hold the column names");
  std::vector<std::string_view> fields;
  split_fields(line, fields);
  for (const std::string_view field : fields) columns_.push_back(without_doubled_quotes(field));
  for (const char separator : {';', '\t'})
    if (columns_.size() == 1 && trimmed(line).find(separator) != std::string_view::npos)
      throw UserError(place(1) + "the columns are separated by " +
                      (separator == ';' ? "semicolons" : "tabs") +
                      "; write them with commas, and numbers with points");
  if (std::all_of(fields.begin(), fields.end(),
                  [](const auto field) { return to_number(field).has_value(); }))
    throw UserError(place(1) + "the first line holds numbers; put a line with column names before");
  for (std::size_t i = 0; i < columns_.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (columns_[i] == columns_[j] && !columns_[i].empty())
        throw UserError(place(1) + "columns " + std::to_string(j + 1) + " and " +
                        std::to_string(i + 1) + " have the same name '" + columns_[i] + "'");
}

bool CsvFile::has(const std::string& column) const {
  return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

std::size_t CsvFile::index_of(const std::string& column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (column.empty() || found == columns_.end())
    throw UserError(place(1) + unknown_name("column", column, columns_));
  return static_cast<std::size_t>(found - columns_.begin());
}

void CsvFile::for_each_row(const std::size_t first, const std::size_t count,
                           const RowReader& read) const {
  assert(first >= 1 && first - 1 <= n_rows_ && count <= n_rows_ - (first - 1));
  const Place from = first >= last_.row ? last_ : Place{1, first_row_at_};
  LineReader lines(bytes_, from.at, end_);
  std::string_view line;
  const auto go_on = [&](const std::size_t row) {
    if (!lines.next(line)) throw UserError(place(row + 1) + "the file ended while it was read");
  };
  for (std::size_t row = from.row; row < first; ++row) go_on(row);
  std::vector<std::string_view> fields;
  for (std::size_t row = first; row < first + count; ++row) {
    go_on(row);
    split_fields(line, fields);
    if (fields.size() != columns_.size() || trimmed(line).empty())
      refuse_row(row + 1, trimmed(line).empty() ? 0 : fields.size());
    read(row + 1, fields);
  }
  last_ = {first + count, lines.position()};
}

void CsvFile::refuse_row(const std::size_t line, const std::size_t n_fields) const {
  if (n_fields == 0) throw UserError(place(line) + "a blank line among the data; remove it");
  throw UserError(place(line) + std::to_string(n_fields) + (n_fields == 1 ? " field" : " fields") +
                  " where the first line names " + std::to_string(columns_.size()) +
                  (columns_.size() == 1 ? " column" : " columns"));
}

std::string CsvFile::place(const std::size_t line) const {
  return name_ + ":" + std::to_string(line) + ": ";
}

}  // namespace vibrissa::signals
