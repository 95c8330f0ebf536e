#include "signals/formats/text/spelling_choice.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string_view>

#include "signals/base/error.h"

namespace vibrissa::signals::formats {
namespace {

// A reading that comes first is preferred to one that gives the same numbers.
constexpr auto all_spellings = std::to_array<Spelling>({{',', '.'},
                                                        {';', '.'},
                                                        {';', ','},
                                                        {'\t', '.'},
                                                        {'\t', ','},
                                                        {' ', '.'},
                                                        {' ', ','},
                                                        {',', ','},
                                                        {'\0', '.'},
                                                        {'\0', ','}});

bool is_value(const std::string_view field, const char decimal) {
  return number_in(field, decimal).has_value() || time_in(field).has_value();
}

// Several numbers in one field, or a number with the other decimal mark: the spelling is wrong.
bool is_unseparated(const std::string_view field, const char decimal) {
  if (field.find_first_not_of("0123456789+-.,;:/ \teE") != std::string_view::npos) return false;
  if (field.find_first_of("0123456789") == std::string_view::npos) return false;
  return field.find_first_of(decimal == '.' ? ",; \t" : ".,; \t") != std::string_view::npos &&
         !is_value(field, decimal);
}

// "05" or "-0" among whole numbers: the digits behind a decimal comma.
bool is_part_of_a_number(std::string_view field) {
  const bool is_negative = field.starts_with('-');
  if (is_negative) field.remove_prefix(1);
  return field.starts_with('0') && (is_negative || field.size() > 1) &&
         field.find_first_not_of("0123456789") == std::string_view::npos;
}

std::vector<const HeadLine*> lines_of_the_table(const std::vector<HeadLine>& head) {
  std::vector<const HeadLine*> lines;
  for (const HeadLine& line : head)
    if (!is_blank(line.text) && !is_comment(line.text)) lines.push_back(&line);
  lines.erase(lines.begin(), lines.begin() + std::ptrdiff_t(lines.size() / 2));
  return lines;
}

using Rows = std::vector<std::vector<std::string_view>>;

Rows rows_of(const std::vector<const HeadLine*>& lines, const char separator) {
  Rows rows;
  for (const HeadLine* const line : lines) rows.push_back(split_line(line->text, separator));
  return rows;
}

std::size_t usual_n_fields(const Rows& rows, const char decimal) {
  std::map<std::size_t, std::size_t> counts;
  for (const auto& fields : rows)
    if (std::any_of(fields.begin(), fields.end(),
                    [&](const auto field) { return is_value(field, decimal); }))
      ++counts[fields.size()];
  std::pair<std::size_t, std::size_t> most{0, 0};
  for (const auto& [n, count] : counts) most = std::max(most, std::pair(count, n));
  return most.second;
}

bool has_odd_field(const std::vector<std::string_view>& fields, const Spelling& spelling) {
  const bool are_whole = std::none_of(fields.begin(), fields.end(), [&](const auto field) {
    return field.find_first_of(".,") != std::string_view::npos &&
           number_in(field, spelling.decimal).has_value();
  });
  return std::any_of(fields.begin(), fields.end(), [&](const auto field) {
    return is_unseparated(field, spelling.decimal) ||
           (spelling.separator == ',' && are_whole && is_part_of_a_number(field));
  });
}

Reading read_as(const Spelling& spelling, const std::vector<const HeadLine*>& lines) {
  const Rows rows = rows_of(lines, spelling.separator);
  Reading reading{.spelling = spelling, .n_fields = usual_n_fields(rows, spelling.decimal)};
  std::vector<std::size_t> n_values(reading.n_fields), n_texts(reading.n_fields);
  for (const auto& fields : rows) {
    ++reading.n_rows;
    if (fields.size() != reading.n_fields || has_odd_field(fields, spelling)) ++reading.n_odd;
    if (fields.size() != reading.n_fields) continue;
    for (std::size_t i = 0; i < fields.size(); ++i)
      if (!fields[i].empty()) ++(is_value(fields[i], spelling.decimal) ? n_values : n_texts)[i];
  }
  for (std::size_t i = 0; i < reading.n_fields; ++i) {
    reading.is_numeric.push_back(n_values[i] > n_texts[i]);
    reading.n_numeric += reading.is_numeric.back();
  }
  return reading;
}

bool give_the_same(const Reading& a, const Reading& b, const std::vector<const HeadLine*>& lines) {
  if (a.n_fields != b.n_fields || a.is_numeric != b.is_numeric) return false;
  return std::all_of(lines.begin(), lines.end(), [&](const HeadLine* const line) {
    const auto left = split_line(line->text, a.spelling.separator);
    const auto right = split_line(line->text, b.spelling.separator);
    return std::equal(left.begin(), left.end(), right.begin(), right.end(),
                      [&](const auto x, const auto y) {
                        return number_in(x, a.spelling.decimal) == number_in(y, b.spelling.decimal);
                      });
  });
}

bool has_names(const Reading& reading, const std::vector<HeadLine>& head) {
  return std::any_of(head.begin(), head.end(), [&](const HeadLine& line) {
    const std::string_view text = is_comment(line.text) ? comment_text(line.text) : line.text;
    return reading.n_fields > 1 && may_be_names(reading, std::string(text));
  });
}

std::string described(const Reading& reading, const std::string& line) {
  static const std::map<char, std::string> words{
      {',', "commas"}, {';', "semicolons"}, {'\t', "tabs"}, {' ', "blanks"}, {'\0', "line ends"}};
  std::string text = words.at(reading.spelling.separator) + " and decimal " +
                     (reading.spelling.decimal == ',' ? "commas" : "points") + " give";
  for (const auto field : split_line(line, reading.spelling.separator))
    text.append(" '").append(field).append("'");
  return text;
}

[[noreturn]] void refuse_doubt(const std::string& file, const HeadLine& line, const Reading& a,
                               const Reading& b) {
  throw UserError(file + ":" + std::to_string(line.number) +
                  ": the line can be read in two ways: " + described(a, line.text) + ", " +
                  described(b, line.text) +
                  "; say which by --separator (comma, semicolon, tab, blank or none) and --decimal "
                  "(point or comma)");
}

// Whether a later line has decimal commas, where the first lines have whole numbers only.
bool has_decimal_commas(const FileBytes& bytes, const std::size_t from, const char separator) {
  LineReader lines(bytes, from, std::numeric_limits<std::size_t>::max());
  std::vector<std::string_view> fields;
  for (std::string_view line; lines.next(line);) {
    if (line.find(',') == std::string_view::npos || is_comment(line)) continue;
    split_fields(line, separator, fields);
    for (const auto field : fields)
      if (field.find(',') != std::string_view::npos && number_in(field, ',')) return true;
  }
  return false;
}

// Those with the fewest odd rows; one of a group that gives the same numbers.
std::vector<Reading> best_readings(std::vector<Reading> readings,
                                   const std::vector<const HeadLine*>& lines) {
  const auto odd_share = [](const Reading& reading) {
    return double(reading.n_odd) / double(std::max<std::size_t>(1, reading.n_rows));
  };
  double least = 1.;
  for (const Reading& reading : readings) least = std::min(least, odd_share(reading));
  constexpr double damaged_rows = 0.005;
  std::erase_if(readings,
                [&](const Reading& reading) { return odd_share(reading) > least + damaged_rows; });
  const bool has_tabs = std::any_of(readings.begin(), readings.end(), [](const Reading& reading) {
    return reading.spelling.separator == '\t' && reading.n_fields > 1;
  });
  std::vector<Reading> different;
  for (const Reading& reading : readings) {
    const bool is_known = std::any_of(different.begin(), different.end(), [&](const auto& other) {
      return give_the_same(other, reading, lines);
    });
    if (!is_known && !(has_tabs && reading.spelling.separator == ' ')) different.push_back(reading);
  }
  return different;
}

bool has_quoted_comma(const std::vector<const HeadLine*>& lines) {
  return std::any_of(lines.begin(), lines.end(), [](const HeadLine* const line) {
    const auto fields = split_line(line->text, ',');
    return std::any_of(fields.begin(), fields.end(),
                       [](const auto field) { return field.find(',') != std::string_view::npos; });
  });
}

std::vector<Reading> possible_readings(const std::vector<const HeadLine*>& lines,
                                       const TextOptions& options) {
  std::vector<Reading> readings;
  for (const Spelling& spelling : all_spellings) {
    if (options.separator && *options.separator != spelling.separator) continue;
    if (options.decimal && *options.decimal != spelling.decimal) continue;
    Reading reading = read_as(spelling, lines);
    // Only quotes separate decimal commas from commas between columns.
    if (spelling == Spelling{',', ','} && !has_quoted_comma(lines)) continue;
    if (reading.has_numbers()) readings.push_back(std::move(reading));
  }
  return readings;
}

// A table of words, such as names without rows.
Reading without_numbers(const std::vector<HeadLine>& head, const TextOptions& options) {
  const auto first = std::find_if(head.begin(), head.end(), [](const HeadLine& line) {
    return !is_blank(line.text) && !is_comment(line.text);
  });
  Reading reading;
  if (first == head.end()) return reading;
  for (const char separator : {',', ';', '\t'}) {
    reading.spelling.separator = options.separator.value_or(separator);
    reading.n_fields = split_line(first->text, reading.spelling.separator).size();
    if (reading.n_fields > 1) return reading;
  }
  reading.spelling.separator = options.separator.value_or(',');
  return reading;
}

}  // namespace

bool is_row(const Reading& reading, const std::string& line) {
  const auto fields = split_line(line, reading.spelling.separator);
  if (fields.size() != reading.n_fields) return false;
  bool has_value = false;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (!reading.is_numeric[i] || fields[i].empty()) continue;
    if (!is_value(fields[i], reading.spelling.decimal)) return false;
    has_value = true;
  }
  return has_value;
}

bool may_be_names(const Reading& reading, const std::string& line) {
  auto fields = split_line(line, reading.spelling.separator);
  if (is_blank(line) || line.find_first_not_of(" \t,;") == std::string::npos) return false;
  while (fields.size() > reading.n_fields && fields.back().empty()) fields.pop_back();
  if (fields.size() > reading.n_fields) return false;
  for (std::size_t i = fields.size(); i < reading.n_fields; ++i)
    if (reading.is_numeric[i]) return false;
  return std::none_of(fields.begin(), fields.end(),
                      [&](const auto field) { return is_value(field, reading.spelling.decimal); });
}

Reading choose_reading(const std::string& file, const FileBytes& bytes,
                       const std::vector<HeadLine>& head, const TextOptions& options) {
  std::vector<HeadLine> table = head;
  std::erase_if(
      table, [&](const HeadLine& line) { return line.number <= options.header_lines.value_or(0); });
  const auto lines = lines_of_the_table(table);
  std::vector<Reading> readings = possible_readings(lines, options);
  if (readings.empty()) return without_numbers(head, options);
  const auto named = [&](const Reading& reading) {
    return 2 * reading.n_odd <= reading.n_rows && has_names(reading, head);
  };
  if (std::any_of(readings.begin(), readings.end(), named))
    std::erase_if(readings, [&](const Reading& reading) { return !named(reading); });
  readings = best_readings(std::move(readings), lines);
  std::stable_sort(readings.begin(), readings.end(),
                   [](const Reading& a, const Reading& b) { return a.n_numeric > b.n_numeric; });
  Reading best = readings.front();
  if (2 * best.n_odd > best.n_rows && best.n_rows > 2)
    throw UserError(file + ":" + std::to_string(lines.front()->number) +
                    ": the columns cannot be told apart" +
                    (lines.front()->text.find(',') == std::string::npos
                         ? "; say how they are separated by --separator and --decimal"
                         : ", because commas both separate them and mark decimals, or rows differ "
                           "in length; export the file with semicolons or with decimal points"));
  if (readings.size() > 1 &&
      (readings[1].n_numeric == best.n_numeric || readings[1].n_numeric == readings[1].n_fields))
    refuse_doubt(file, *lines.front(), best, readings[1]);
  if (!options.decimal && best.spelling.decimal == '.' && best.spelling.separator != ',' &&
      std::none_of(lines.begin(), lines.end(),
                   [](const auto* line) { return line->text.find('.') != std::string::npos; }) &&
      has_decimal_commas(bytes, lines.front()->at, best.spelling.separator))
    best.spelling.decimal = ',';
  return best;
}

}  // namespace vibrissa::signals::formats
