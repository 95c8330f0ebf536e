#include "signals/formats/csv_file.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <system_error>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/base/trimmed.h"

namespace vibrissa::signals {
namespace {

FileBytes open_bytes(const std::filesystem::path& file) {
  if (std::error_code ignored; std::filesystem::is_directory(file, ignored))
    throw UserError(file.string() + ": this is a folder, not a CSV file");
  return FileBytes(file);
}

constexpr std::size_t everything = std::numeric_limits<std::size_t>::max();
constexpr const char* blanks = " \t\r\n";

// End of the field that starts at `at`: its comma, or the end of the line. Only a field that starts
// with a quote may contain commas.
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

std::size_t n_fields(const std::string_view line) {
  std::vector<std::string_view> fields;
  split_fields(line, fields);
  return fields.size();
}

bool holds_numbers(const std::string_view line) {
  std::vector<std::string_view> fields;
  split_fields(line, fields);
  return std::all_of(fields.begin(), fields.end(),
                     [](const auto field) { return to_number(field).has_value(); });
}

}  // namespace

CsvFile::CsvFile(const std::filesystem::path& file)
    : name_(file.string()), bytes_(open_bytes(file)) {
  const std::string_view byte_order_mark = "\xEF\xBB\xBF";
  std::string mark(byte_order_mark.size(), ' ');
  bytes_.read(0, mark.data(), mark.size());
  const std::size_t start = mark == byte_order_mark ? byte_order_mark.size() : 0;
  find_names(start);
  find_end();
  last_ = {1, first_row_at_};
}

void CsvFile::find_names(const std::size_t start) {
  LineReader lines(bytes_, start, everything);
  std::string comment;  // the last one
  std::string_view line;
  std::size_t number = 0, at = start;
  for (;; comment = line.substr(1)) {
    at = lines.position();
    if (!lines.next(line)) throw UserError(name_ + ": the file is empty");
    ++number;
    if (!line.starts_with('#')) break;
  }
  if (is_blank_from(at)) throw UserError(name_ + ": the file is empty");
  const bool names_are_before = !comment.empty() && holds_numbers(line) &&
                                n_fields(comment) == n_fields(line) && !holds_numbers(comment);
  line_of_names_ = names_are_before ? number - 1 : number;
  first_row_at_ = names_are_before ? at : lines.position();
  read_names(names_are_before ? std::string_view(comment) : line);
}

bool CsvFile::is_blank_from(const std::size_t start) const {
  LineReader lines(bytes_, start, everything);
  for (std::string_view line; lines.next(line);)
    if (line.find_last_not_of(blanks) != std::string_view::npos) return false;
  return true;
}

// Ignores blank lines at the end.
void CsvFile::find_end() {
  LineReader lines(bytes_, first_row_at_, everything);
  std::size_t n_lines = 0;
  end_ = first_row_at_;
  std::size_t at = lines.position();
  for (std::string_view line; lines.next(line); at = lines.position()) {
    ++n_lines;
    const auto last = line.find_last_not_of(blanks);
    if (last == std::string_view::npos) continue;
    end_ = at + last + 1;
    n_rows_ = n_lines;
  }
}

void CsvFile::read_names(const std::string_view line) {
  if (trimmed(line).empty())
    throw UserError(place(line_of_names_) +
                    "the first line is blank; it must hold the column names");
  std::vector<std::string_view> fields;
  split_fields(line, fields);
  for (const std::string_view field : fields) columns_.push_back(without_doubled_quotes(field));
  for (const char separator : {';', '\t'})
    if (columns_.size() == 1 && trimmed(line).find(separator) != std::string_view::npos)
      throw UserError(place(line_of_names_) + "the columns are separated by " +
                      (separator == ';' ? "semicolons" : "tabs") +
                      "; separate them by commas, and write numbers with a decimal point");
  if (holds_numbers(line))
    throw UserError(
        place(line_of_names_) +
        "the first line contains numbers; insert a line with the column names before it");
  for (std::size_t i = 0; i < columns_.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (columns_[i] == columns_[j] && !columns_[i].empty())
        throw UserError(place(line_of_names_) + "columns " + std::to_string(j + 1) + " and " +
                        std::to_string(i + 1) + " have the same name '" + columns_[i] + "'");
}

bool CsvFile::has(const std::string& column) const {
  return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

std::size_t CsvFile::index_of(const std::string& column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (column.empty() || found == columns_.end())
    throw UserError(place(line_of_names_) + unknown_name("column", column, columns_));
  return static_cast<std::size_t>(found - columns_.begin());
}

void CsvFile::for_each_row(const std::size_t first, const std::size_t count,
                           const RowReader& read) const {
  assert(first >= 1 && first - 1 <= n_rows_ && count <= n_rows_ - (first - 1));
  const Place from = first >= last_.row ? last_ : Place{1, first_row_at_};
  LineReader lines(bytes_, from.at, end_);
  std::string_view line;
  const auto go_on = [&](const std::size_t row) {
    if (!lines.next(line))
      throw UserError(place(line_of(row)) + "the file ended unexpectedly while it was read");
  };
  for (std::size_t row = from.row; row < first; ++row) go_on(row);
  std::vector<std::string_view> fields;
  for (std::size_t row = first; row < first + count; ++row) {
    go_on(row);
    split_fields(line, fields);
    if (fields.size() != columns_.size() || trimmed(line).empty())
      refuse_row(line_of(row), trimmed(line).empty() ? 0 : fields.size());
    read(line_of(row), fields);
  }
  last_ = {first + count, lines.position()};
}

void CsvFile::refuse_row(const std::size_t line, const std::size_t n_fields) const {
  if (n_fields == 0) throw UserError(place(line) + "blank line between the data; remove it");
  throw UserError(place(line) + std::to_string(n_fields) + (n_fields == 1 ? " field" : " fields") +
                  ", but the first line names " + std::to_string(columns_.size()) +
                  (columns_.size() == 1 ? " column" : " columns"));
}

std::string CsvFile::place(const std::size_t line) const {
  return name_ + ":" + std::to_string(line) + ": ";
}

}  // namespace vibrissa::signals
