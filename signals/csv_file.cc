#include "signals/csv_file.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "signals/error.h"
#include "signals/number_text.h"

namespace vibrissa::signals {
namespace {

std::string read_text(const std::filesystem::path& file) {
  if (std::error_code ignored; std::filesystem::is_directory(file, ignored))
    throw UserError(file.string() + ": this is a folder, not a CSV file");
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::string text;
  std::vector<char> block(std::size_t{1} << 20);
  while (stream) {
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    text.append(block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.eof())
    throw UserError(file.string() + ": cannot be read: " + std::generic_category().message(errno));
  return text;
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") + 1 - first);
}

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

CsvFile::CsvFile(const std::filesystem::path& file) : name_(file.string()), text_(read_text(file)) {
  const std::string_view byte_order_mark = "\xEF\xBB\xBF";
  const std::size_t start = text_.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  text_.erase(text_.find_last_not_of(" \t\r\n") + 1);
  if (text_.size() <= start) throw UserError(name_ + ": the file is empty");
  const std::size_t header_end = std::min(text_.find('\n', start), text_.size());
  read_header(std::string_view(text_).substr(start, header_end - start));
  n_rows_ = static_cast<std::size_t>(std::count(text_.begin(), text_.end(), '\n'));
  first_row_at_ = std::min(header_end + 1, text_.size());
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
  const std::string_view text = text_;
  std::size_t at = first_row_at_;
  for (std::size_t row = 1; row < first; ++row) at = text.find('\n', at) + 1;
  std::vector<std::string_view> fields;
  for (std::size_t row = first; row < first + count; ++row) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    split_fields(line, fields);
    if (fields.size() != columns_.size() || trimmed(line).empty())
      refuse_row(row + 1, trimmed(line).empty() ? 0 : fields.size());
    read(row + 1, fields);
    at = end + 1;
  }
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
