#include "report/figures/table.h"

#include <algorithm>
#include <cassert>

#include "report/text/html_text.h"
#include "report/text/text.h"
#include "signals/base/number_text.h"

namespace vibrissa::report {
namespace {

std::string heading(const Column& column) {
  return column.unit.empty() ? column.name : column.name + " [" + column.unit + "]";
}

std::string padded(const std::string& text, const std::size_t width, const bool right) {
  const std::string blanks(width - n_characters(text), ' ');
  return right ? blanks + text : text + blanks;
}

std::string without_trailing_blanks(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

std::string markdown_field(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c == '\n' ? ' ' : c;
  }
  return escaped;
}

}  // namespace

std::string Cell::rounded(const int n_digits) const {
  if (const auto* number = std::get_if<double>(&value_)) return significant(*number, n_digits);
  return std::holds_alternative<std::monostate>(value_) ? "-" : exact();
}

std::string Cell::exact() const {
  if (const auto* number = std::get_if<double>(&value_)) return signals::to_text(*number);
  if (const auto* count = std::get_if<long long>(&value_)) return std::to_string(*count);
  if (const auto* text = std::get_if<std::string>(&value_)) return *text;
  return "";
}

Table::Table(std::vector<Column> columns) : columns_(std::move(columns)) {
  assert(!columns_.empty());
}

void Table::add_row(std::vector<Cell> row) {
  assert(row.size() == columns_.size());
  rows_.push_back(std::move(row));
}

std::string Table::to_csv() const {
  std::string csv;
  const auto add_line = [&](const auto& items, const auto& text_of) {
    for (std::size_t c = 0; c < items.size(); ++c)
      csv.append(c == 0 ? "" : ",").append(csv_field(text_of(items[c])));
    csv += '\n';
  };
  add_line(columns_, heading);
  for (const auto& row : rows_) add_line(row, [](const Cell& cell) { return cell.exact(); });
  return csv;
}

Table::Text Table::rounded_text() const {
  const std::size_t n_columns = columns_.size();
  Text text{{{}}, std::vector<std::size_t>(n_columns, 3), std::vector<bool>(n_columns, true)};
  for (const Column& column : columns_) text.lines.front().push_back(heading(column));
  for (const auto& row : rows_) {
    auto& line = text.lines.emplace_back();
    for (std::size_t c = 0; c < n_columns; ++c) {
      line.push_back(row[c].rounded(columns_[c].n_digits));
      if (row[c].is_text()) text.right[c] = false;
    }
  }
  for (const auto& line : text.lines)
    for (std::size_t c = 0; c < n_columns; ++c)
      text.widths[c] = std::max(text.widths[c], n_characters(line[c]));
  return text;
}

std::string Table::to_markdown() const {
  const Text text = rounded_text();
  std::string markdown;
  for (std::size_t l = 0; l < text.lines.size(); ++l) {
    markdown += '|';
    for (const auto& field : text.lines[l])
      markdown.append(" ").append(markdown_field(field) + " |");
    markdown += '\n';
    if (l != 0) continue;
    markdown += '|';
    for (const bool right : text.right) markdown += right ? "---:|" : "---|";
    markdown += '\n';
  }
  return markdown;
}

std::string Table::to_html(const std::string& caption) const {
  const Text text = rounded_text();
  std::string html = "<table><caption>" + html_escaped(caption) + "</caption>\n<thead>";
  for (std::size_t l = 0; l < text.lines.size(); ++l) {
    const bool head = l == 0;
    html += "<tr>";
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      html += head ? "<th scope=\"col\"" : "<td";
      html += text.right[c] ? " class=\"number\">" : ">";
      html += html_escaped(text.lines[l][c]);
      html += head ? "</th>" : "</td>";
    }
    html += head ? "</tr></thead>\n<tbody>\n" : "</tr>\n";
  }
  return html + "</tbody></table>\n";
}

std::string Table::to_text() const {
  const Text text = rounded_text();
  std::string all;
  for (std::size_t l = 0; l < text.lines.size(); ++l) {
    std::string line, rule;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const std::string gap = c == 0 ? "" : "  ";
      line += gap + padded(text.lines[l][c], text.widths[c], text.right[c]);
      rule += gap + std::string(text.widths[c], '-');
    }
    all += without_trailing_blanks(line) + '\n';
    if (l == 0) all += rule + '\n';
  }
  return all;
}

}  // namespace vibrissa::report
