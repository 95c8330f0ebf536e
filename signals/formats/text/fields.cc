#include "signals/formats/text/fields.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstddef>

#include "signals/base/number_text.h"
#include "signals/base/trimmed.h"

namespace vibrissa::signals::formats {
namespace {

constexpr const char* blanks = " \t\r\n";

bool is_digit(const char c) {
  return c >= '0' && c <= '9';
}

// End of the field that starts at `at`: its separator, or the end of the line.
std::size_t field_end(const std::string_view line, const std::size_t at, const char separator) {
  const auto is_end = [&](const char c) {
    return separator == ' ' ? c == ' ' || c == '\t' : separator != 0 && c == separator;
  };
  std::size_t start = at;
  while (start < line.size() && (line[start] == ' ' || line[start] == '\t') && !is_end(line[start]))
    ++start;
  if (start == line.size() || line[start] != '"') {
    while (start < line.size() && !is_end(line[start])) ++start;
    return start;
  }
  bool quoted = true;
  std::size_t end = start + 1;
  for (; end < line.size() && (quoted || !is_end(line[end])); ++end)
    if (line[end] == '"') quoted = !quoted;
  return end;
}

// Most lines have neither quotes nor blanks, and need one look at each character. False for others.
bool split_plain(std::string_view line, const char separator,
                 std::vector<std::string_view>& fields) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  const char* at = line.data();
  for (const char *c = at, *const end = at + line.size();; ++c) {
    if (c == end || *c == separator) {
      fields.emplace_back(at, std::size_t(c - at));
      if (c == end) return true;
      at = c + 1;
    } else if (*c == '"' || (*c >= 0 && *c <= ' ')) {
      return false;
    }
  }
}

std::string_view without_quotes(std::string_view field) {
  field = trimmed(field);
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
    return trimmed(field.substr(1, field.size() - 2));
  return field;
}

// Reads a whole number of at most so many digits off the front.
std::optional<int> take_whole(std::string_view& text, const std::size_t most_digits) {
  std::size_t n = 0;
  int value = 0;
  while (n < text.size() && n < most_digits && is_digit(text[n]))
    value = 10 * value + (text[n++] - '0');
  if (n == 0) return {};
  text.remove_prefix(n);
  return value;
}

bool take(std::string_view& text, const std::string_view any_of) {
  if (text.empty() || any_of.find(text.front()) == std::string_view::npos) return false;
  text.remove_prefix(1);
  return true;
}

std::optional<double> take_date(std::string_view& text) {
  const auto year = take_whole(text, 4);
  if (!year || *year < 1900 || !take(text, "-/.")) return {};
  const auto month = take_whole(text, 2);
  if (!month || !take(text, "-/.")) return {};
  const auto day = take_whole(text, 2);
  if (!day) return {};
  const std::chrono::year_month_day date{std::chrono::year(*year),
                                         std::chrono::month(unsigned(*month)),
                                         std::chrono::day(unsigned(*day))};
  if (!date.ok()) return {};
  return 86400. * double(std::chrono::sys_days(date).time_since_epoch().count());
}

std::optional<double> take_time_of_day(std::string_view& text) {
  const auto hour = take_whole(text, 2);
  if (!hour || *hour > 24 || !take(text, ":.")) return {};
  const auto minute = take_whole(text, 2);
  if (!minute || *minute > 59) return {};
  double seconds = 0.;
  if (take(text, ":.")) {
    const auto whole = take_whole(text, 2);
    if (!whole || *whole > 60) return {};
    seconds = *whole;
    if (text.size() > 1 && (text[0] == '.' || text[0] == ',') && is_digit(text[1])) {
      text.remove_prefix(1);
      double place = 0.1;
      for (; !text.empty() && is_digit(text[0]); place /= 10., text.remove_prefix(1))
        seconds += place * (text[0] - '0');
    }
  }
  return 3600. * *hour + 60. * *minute + seconds;
}

// Offset of the time zone, s; nothing where other text follows.
std::optional<double> zone(std::string_view text) {
  if (text.empty() || text == "Z") return 0.;
  const double sign = text.front() == '-' ? -1. : 1.;
  if (!take(text, "+-")) return {};
  const auto hour = take_whole(text, 2);
  if (!hour) return {};
  take(text, ":");
  const int minute = take_whole(text, 2).value_or(0);
  if (!text.empty()) return {};
  return sign * (3600. * *hour + 60. * minute);
}

}  // namespace

void split_fields(const std::string_view whole, const char separator,
                  std::vector<std::string_view>& fields) {
  fields.clear();
  if (separator != ' ' && separator != 0 && split_plain(whole, separator, fields)) return;
  fields.clear();
  const std::string_view line = separator == ' ' ? trimmed(whole) : whole;
  for (std::size_t at = 0;;) {
    const std::size_t end = field_end(line, at, separator);
    fields.push_back(without_quotes(line.substr(at, end - at)));
    if (end == line.size()) return;
    at = end + 1;
    while (separator == ' ' && (line[at] == ' ' || line[at] == '\t')) ++at;
  }
}

std::vector<std::string_view> split_line(const std::string_view line, const char separator) {
  std::vector<std::string_view> fields;
  split_fields(line, separator, fields);
  return fields;
}

std::optional<double> number_in(const std::string_view field, const char decimal) {
  if (decimal == '.') return to_number(field);
  const std::size_t comma = field.find(',');
  if (comma == std::string_view::npos)
    return field.find('.') == std::string_view::npos ? to_number(field) : std::nullopt;
  std::array<char, 64> text;
  if (field.size() > text.size() || comma == 0 || comma + 1 == field.size() ||
      !is_digit(field[comma - 1]) || !is_digit(field[comma + 1]) ||
      field.find('.') != std::string_view::npos)
    return {};
  std::copy(field.begin(), field.end(), text.begin());
  text[comma] = '.';
  return to_number({text.data(), field.size()});
}

std::optional<double> time_in(std::string_view field) {
  constexpr std::size_t shortest = 7, longest = 40;
  if (field.size() < shortest || field.size() > longest || !is_digit(field.front())) return {};
  const bool has_date = field.size() >= 8 && is_digit(field[2]) && is_digit(field[3]);
  double seconds = 0.;
  if (has_date) {
    const auto date = take_date(field);
    if (!date) return {};
    seconds = *date;
    if (field.empty()) return seconds;
    if (!take(field, "T _")) return {};
  }
  const auto time = take_time_of_day(field);
  const auto offset = zone(trimmed(field));
  if (!time || !offset) return {};
  return seconds + *time - *offset;
}

std::string_view printed_seconds(std::string_view time) {
  const std::size_t of_day = time.find_first_of("T ");
  std::size_t at = of_day == std::string_view::npos ? 0 : of_day + 1;
  for (int i = 0; i < 2; ++i) {
    const std::size_t mark = time.find_first_of(":.", at);
    if (mark == std::string_view::npos) break;
    at = mark + 1;
  }
  const std::string_view rest = time.substr(at);
  return rest.substr(0, std::min(rest.find_first_not_of("0123456789."), rest.size()));
}

bool is_blank(const std::string_view line) {
  return line.find_first_not_of(blanks) == std::string_view::npos;
}

bool is_comment(const std::string_view line) {
  const std::size_t at = line.find_first_not_of(" \t");
  return at != std::string_view::npos &&
         (line[at] == '#' || line[at] == '%' || line.substr(at).starts_with("//"));
}

std::string_view comment_text(const std::string_view line) {
  const std::size_t at = line.find_first_not_of("#%/ \t");
  return at == std::string_view::npos ? std::string_view() : trimmed(line.substr(at));
}

}  // namespace vibrissa::signals::formats
