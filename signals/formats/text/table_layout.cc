#include "signals/formats/text/table_layout.h"

#include <algorithm>
#include <limits>
#include <map>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/formats/text/head_parts.h"
#include "signals/formats/text/labview_layout.h"
#include "signals/formats/text/spelling_choice.h"
#include "signals/record/channel_name.h"

namespace vibrissa::signals::formats {
namespace {

constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();

std::string table_line(const HeadLine& line) {
  return std::string(is_comment(line.text) ? comment_text(line.text) : std::string_view(line.text));
}

bool holds_a_channel(const Reading& reading, const std::string& line) {
  const auto fields = split_line(line, reading.spelling.separator);
  return std::any_of(fields.begin(), fields.end(), [](const auto field) {
    return !field.empty() && full_channel_name(std::string(field)) == field;
  });
}

// Index of the first row; the number of lines where there is none.
std::size_t first_row(const std::vector<HeadLine>& head, const Reading& reading) {
  for (std::size_t i = 0; i < head.size(); ++i)
    if (!is_comment(head[i].text) && !is_blank(head[i].text) && is_row(reading, head[i].text))
      return i;
  return head.size();
}

// "Device: D4E9, filter = 488 Hz": entries of a logger, no names.
bool holds_entries(const HeadLine& line) {
  return rate_in(line.text).has_value() ||
         (is_comment(line.text) && line.text.find_first_of("=:") != std::string::npos);
}

bool is_units_line(const HeadLine& line, const Reading& reading) {
  return units_in(split_line(table_line(line), reading.spelling.separator)).has_value();
}

// Index of the line with the names before line `end`: one with the name of a channel, or the last
// one that is not a line of units; lines that are no comments first.
std::size_t find_names(const std::vector<HeadLine>& head, const std::size_t end,
                       const Reading& reading) {
  std::size_t units = nowhere;
  for (const bool in_comments : {false, true}) {
    std::vector<std::size_t> possible;
    for (std::size_t i = 0; i < end; ++i)
      if (is_comment(head[i].text) == in_comments && !holds_entries(head[i]) &&
          may_be_names(reading, table_line(head[i])))
        possible.push_back(i);
    for (const std::size_t i : possible)
      if (holds_a_channel(reading, table_line(head[i]))) return i;
    for (std::size_t i = possible.size(); i-- > 0;)
      if (!is_units_line(head[possible[i]], reading)) return possible[i];
    if (units == nowhere && !possible.empty()) units = possible.front();
  }
  return units;
}

// The line before the rows looks like names but has another number of fields.
void check_names_fit(const std::string& file, const std::vector<HeadLine>& head,
                     const std::size_t end, const Reading& reading) {
  for (std::size_t i = end; i-- > 0;) {
    if (is_blank(head[i].text) || is_comment(head[i].text)) continue;
    const std::size_t n = split_line(head[i].text, reading.spelling.separator).size();
    if (n < 2 || reading.n_fields == 0) return;
    const std::string line = std::to_string(head[i].number);
    throw UserError(
        file + ":" + std::to_string(head[end].number) + ": " + std::to_string(reading.n_fields) +
        (reading.n_fields == 1 ? " field" : " fields") + ", but " +
        (line == "1" ? "the first line" : "line " + line) + " names " + std::to_string(n) +
        " columns; where line " + line + " holds no names, give --header-lines " + line);
  }
}

bool separates_only(const std::string& line) {
  return line.find_first_not_of(" \t\r-=_+|*,;") == std::string::npos;
}

void take_names(const std::vector<HeadLine>& head, const std::size_t names, const std::size_t row,
                const Reading& reading, TableLayout& layout) {
  const std::string line = table_line(head[names]);
  const auto fields = split_line(line, reading.spelling.separator);
  std::size_t n_columns = fields.size();
  while (n_columns > reading.n_fields && fields[n_columns - 1].empty()) --n_columns;
  layout.names = column_names(fields, std::max(n_columns, reading.n_fields));
  layout.line_of_names = head[names].number;
  layout.units.assign(layout.names.size(), "");
  std::size_t next = names + 1;
  const auto skip = [&] {
    while (next < row && (is_blank(head[next].text) || is_comment(head[next].text) ||
                          separates_only(head[next].text)))
      ++next;
  };
  skip();
  const std::size_t units = next < row ? next : names + 1;
  if (units < row && may_be_names(reading, table_line(head[units]))) {
    const std::string text = table_line(head[units]);
    if (auto stated = units_in(split_line(text, reading.spelling.separator))) {
      stated->resize(layout.names.size());
      layout.units = *stated;
      layout.line_of_units = head[units].number;
      next = std::max(next, units + 1);
    }
  }
  skip();
  if (next >= head.size()) return;
  layout.first_line = head[next].number;
  layout.first_at = head[next].at;
}

void take_rate(const std::vector<HeadLine>& head, const std::size_t row, TableLayout& layout) {
  for (std::size_t i = 0; i < row && i < head.size(); ++i) {
    if (head[i].number == layout.line_of_names) continue;
    if (const auto rate = rate_in(head[i].text)) {
      layout.rate = {*rate, 0., "line " + std::to_string(head[i].number)};
      return;
    }
  }
}

std::optional<double> value_of_all(const HeadLine& line, const Reading& reading) {
  std::optional<double> value;
  for (const auto field : split_line(line.text, reading.spelling.separator)) {
    const auto number = number_in(field, reading.spelling.decimal);
    if (!number || (value && *value != *number)) return {};
    value = number;
  }
  return value;
}

// Wearables write the start in seconds since 1970 and the rate as the first two rows, in every
// column.
void take_start_and_rate_rows(const std::vector<HeadLine>& head, const std::size_t row,
                              const Reading& reading, TableLayout& layout) {
  constexpr double year_2001_s = 978307200., year_2100_s = 4102444800., highest_hz = 1e5;
  if (layout.line_of_names != 0 || row + 2 >= head.size()) return;
  const auto start = value_of_all(head[row], reading);
  const auto rate = value_of_all(head[row + 1], reading);
  if (!start || !rate || *start < year_2001_s || *start > year_2100_s || !(*rate > 0.) ||
      *rate > highest_hz)
    return;
  const std::string number = std::to_string(head[row + 1].number);
  layout.rate = {*rate, *start, "line " + number, true};
  layout.first_line = head[row + 2].number;
  layout.first_at = head[row + 2].at;
}

TableLayout layout_behind_header(const std::vector<HeadLine>& head, const Reading& reading,
                                 const std::size_t n_lines) {
  TableLayout layout{.spelling = reading.spelling, .n_fields = reading.n_fields};
  std::size_t row = 0;
  while (row < head.size() && head[row].number <= n_lines) ++row;
  const std::size_t names = find_names(head, row, reading);
  layout.names = column_names({}, reading.n_fields);
  if (names != nowhere) take_names(head, names, row, reading, layout);
  layout.units.resize(layout.names.size());
  if (row < head.size()) {
    layout.first_line = head[row].number;
    layout.first_at = head[row].at;
  }
  take_rate(head, row, layout);
  return layout;
}

void set_no_rows(const std::string& file, const std::vector<HeadLine>& head, const Reading& reading,
                 TableLayout& layout) {
  std::size_t names = 0;
  while (names < head.size() && (is_comment(head[names].text) || is_blank(head[names].text)))
    ++names;
  if (names == head.size()) throw UserError(file + ": the file is empty");
  const auto fields = split_line(head[names].text, reading.spelling.separator);
  layout.names = column_names(fields, fields.size());
  layout.n_fields = layout.names.size();
  layout.line_of_names = head[names].number;
  layout.first_line = head[names].number + 1;
  layout.first_at = names + 1 < head.size() ? head[names + 1].at : nowhere;
  layout.units.resize(layout.names.size());
}

}  // namespace

std::vector<HeadLine> read_head_lines(const FileBytes& bytes, const std::size_t start) {
  constexpr std::size_t most_lines = 1000, most_bytes = std::size_t{1} << 23;
  std::vector<HeadLine> head;
  LineReader lines(bytes, start, nowhere);
  std::size_t at = start;
  for (std::string_view line;
       head.size() < most_lines && at - start < most_bytes && lines.next(line);
       at = lines.position()) {
    if (line.ends_with('\r')) line.remove_suffix(1);
    head.push_back({head.size() + 1, at, std::string(line)});
  }
  return head;
}

TableLayout find_layout(const std::string& file, const FileBytes& bytes, const std::size_t start,
                        const TextOptions& options) {
  const std::vector<HeadLine> head = read_head_lines(bytes, start);
  if (is_labview(head) && !options.header_lines) return labview_layout(file, head, options);
  const Reading reading = choose_reading(file, bytes, head, options);
  if (options.header_lines && reading.has_numbers())
    return layout_behind_header(head, reading, *options.header_lines);
  TableLayout layout{.spelling = reading.spelling, .n_fields = reading.n_fields};
  const std::size_t row = reading.has_numbers() ? first_row(head, reading) : head.size();
  if (row == head.size()) {
    set_no_rows(file, head, reading, layout);
    return layout;
  }
  layout.first_line = head[row].number;
  layout.first_at = head[row].at;
  const std::size_t names = find_names(head, row, reading);
  if (names == nowhere) {
    check_names_fit(file, head, row, reading);
    layout.names = column_names({}, reading.n_fields);
    layout.units.resize(layout.names.size());
    take_start_and_rate_rows(head, row, reading, layout);
  } else {
    take_names(head, names, row, reading, layout);
  }
  if (!layout.rate) take_rate(head, row, layout);
  return layout;
}

std::string to_string(const TableLayout& layout) {
  static const std::map<char, std::string> words{
      {',', "commas"}, {';', "semicolons"}, {'\t', "tabs"}, {' ', "blanks"}, {'\0', "one column"}};
  std::string text = layout.is_labview ? "LabVIEW measurement, " : "";
  text += layout.n_fields == 1 ? "one column" : words.at(layout.spelling.separator);
  text += layout.spelling.decimal == ',' ? ", decimal commas" : ", decimal points";
  text += layout.line_of_names == 0 ? ", no names"
                                    : ", names in line " + std::to_string(layout.line_of_names);
  if (layout.line_of_units != 0) text += ", units in line " + std::to_string(layout.line_of_units);
  if (layout.rate) text += ", " + to_text(layout.rate->rate_hz) + " Hz from " + layout.rate->source;
  return text;
}

}  // namespace vibrissa::signals::formats
