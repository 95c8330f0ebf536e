#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace vibrissa::report {

/// One entry of a table: a number, a count, a text or nothing (unknown, not measured).
class Cell {
 public:
  Cell() = default;
  Cell(const double number) : value_(number) {}
  Cell(const std::optional<double>& number) {
    if (number) value_ = *number;
  }
  Cell(const std::integral auto count) : value_(static_cast<long long>(count)) {}
  Cell(std::string text) : value_(std::move(text)) {}
  Cell(const char* text) : value_(std::string(text)) {}

  bool is_text() const { return std::holds_alternative<std::string>(value_); }
  /// Rounded to n_digits significant digits; "-" for nothing and for NaN.
  std::string rounded(int n_digits) const;
  /// The number with all digits; empty for nothing, "nan" for NaN.
  std::string exact() const;

 private:
  std::variant<std::monostate, double, long long, std::string> value_;
};

/// Heading of a column, shown as "name [unit]". unit is empty for a dimensionless number or a text.
struct Column {
  std::string name;
  std::string unit;
  int n_digits = 4;  // significant digits shown to people; a CSV file keeps all of them
};

/// A small table of results. Proven by tests/report/figures/table_test.cc.
class Table {
 public:
  explicit Table(std::vector<Column> columns);

  /// One cell per column, in the order of the columns.
  void add_row(std::vector<Cell> row);
  std::size_t n_rows() const { return rows_.size(); }

  /// RFC 4180 with a header line; numbers in the shortest form that reads back to the same double.
  std::string to_csv() const;
  /// GitHub's table form; numbers to the right.
  std::string to_markdown() const;
  /// A table element with a caption, headings with their scope and numbers in cells of class
  /// "number"; all text is escaped.
  std::string to_html(const std::string& caption) const;
  /// Aligned columns with a rule under the heading; numbers to the right.
  std::string to_text() const;

 private:
  struct Text {
    std::vector<std::vector<std::string>> lines;  // heading first
    std::vector<std::size_t> widths;
    std::vector<bool> right;
  };
  Text rounded_text() const;

  std::vector<Column> columns_;
  std::vector<std::vector<Cell>> rows_;
};

}  // namespace vibrissa::report
