#include "signals/formats/text/head_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <set>

#include "signals/base/number_text.h"
#include "signals/base/trimmed.h"
#include "signals/base/unit.h"
#include "signals/base/utf_8.h"

namespace vibrissa::signals::formats {
namespace {

std::string without_doubled_quotes(const std::string_view name) {
  std::string result;
  for (std::size_t i = 0; i < name.size(); ++i) {
    result += name[i];
    if (name.substr(i).starts_with("\"\"")) ++i;
  }
  return result;
}

std::string_view without_brackets(std::string_view text) {
  const bool is_in_brackets = text.size() > 2 && ((text.front() == '[' && text.back() == ']') ||
                                                  (text.front() == '(' && text.back() == ')'));
  return is_in_brackets ? trimmed(text.substr(1, text.size() - 2)) : text;
}

std::optional<double> positive_number(std::string text) {
  std::replace(text.begin(), text.end(), ',', '.');
  const auto value = to_number(text);
  return value && std::isfinite(*value) && *value > 0. ? value : std::nullopt;
}

}  // namespace

std::vector<std::string> column_names(const std::vector<std::string_view>& fields,
                                      const std::size_t n_columns) {
  std::vector<std::string> names;
  std::map<std::string, std::size_t> counts;
  for (std::size_t i = 0; i < n_columns; ++i) {
    const std::string given = i < fields.size() ? without_doubled_quotes(fields[i]) : "";
    names.push_back(given.empty() ? "column_" + std::to_string(i + 1) : as_utf_8(given));
    ++counts[names.back()];
  }
  std::set<std::string> known(names.begin(), names.end());
  std::map<std::string, std::size_t> numbers;
  for (std::string& name : names) {
    if (counts[name] == 1) continue;
    std::string numbered;
    do numbered = name + "_" + std::to_string(++numbers[name]);
    while (known.count(numbered) != 0);
    known.insert(name = numbered);
  }
  return names;
}

std::optional<std::vector<std::string>> units_in(const std::vector<std::string_view>& fields) {
  std::vector<std::string> units;
  bool has_unit = false;
  for (const std::string_view field : fields) {
    const std::string unit = as_utf_8(without_brackets(field));
    const bool is_absent = unit.empty() || unit == "-" || unit == "--";
    if (!is_absent && !is_unit(unit)) return {};
    has_unit = has_unit || !is_absent;
    units.push_back(is_absent ? "" : unit);
  }
  return has_unit ? std::optional(units) : std::nullopt;
}

std::optional<double> rate_in(const std::string& line) {
  constexpr auto flags = std::regex::icase | std::regex::optimize;
  static const std::regex rate(
      "(?:sampl\\w*[ _-]*(?:rate|freq\\w*)|data[ _-]*rate|\\bfs|\\brate|abtastrate|"
      "abtastfrequenz|\\bodr)[^0-9\\w]*(?:hz)?[^0-9\\w]*([0-9][0-9.,]*(?:e[+-]?[0-9]+)?)\\s*"
      "(k?hz|k?s/s|k?sps|samples/s)?",
      flags);
  static const std::regex period(
      "(?:sampl\\w*[ _-]*(?:period|interval|time)|\\bdt|\\bts|delta_x|increment)[^0-9\\w]*"
      "([0-9][0-9.,]*(?:e[+-]?[0-9]+)?)\\s*(ms|us|s)\\b",
      flags);
  const auto number = [](std::string text) {
    while (text.ends_with(',') || text.ends_with('.')) text.pop_back();
    return positive_number(text);
  };
  std::smatch found;
  if (line.size() > 4096) return {};
  if (std::regex_search(line, found, rate)) {
    const auto value = number(found.str(1));
    const std::string unit = found.str(2);
    const double factor = unit.starts_with('k') || unit.starts_with('K') ? 1e3 : 1.;
    if (value) return *value * factor;
  }
  if (std::regex_search(line, found, period)) {
    const auto value = number(found.str(1));
    const std::string unit = found.str(2);
    if (value) return 1. / (*value * (unit == "ms" ? 1e-3 : unit == "us" ? 1e-6 : 1.));
  }
  return {};
}

}  // namespace vibrissa::signals::formats
