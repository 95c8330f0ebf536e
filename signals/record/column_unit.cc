#include "signals/record/column_unit.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "signals/base/lower_case.h"
#include "signals/base/trimmed.h"
#include "signals/base/unit.h"
#include "signals/record/channel_name.h"

namespace vibrissa::signals {
namespace {

// The part before `open` and that between it and the last character.
NamedUnit parted(const std::string& column, const std::size_t open, const std::size_t end) {
  return {std::string(trimmed(std::string_view(column).substr(0, open))),
          std::string(trimmed(std::string_view(column).substr(open + 1, end - open - 1)))};
}

bool is_whole(const NamedUnit& found) {
  return !found.name.empty() && !found.unit.empty() && is_unit(found.unit);
}

}  // namespace

NamedUnit split_unit(const std::string& column) {
  for (const auto& [open, close] : {std::pair('[', ']'), std::pair('(', ')')}) {
    const std::size_t at = column.rfind(open);
    if (at == std::string::npos || !column.ends_with(close)) continue;
    if (const NamedUnit found = parted(column, at, column.size() - 1); is_whole(found))
      return found;
  }
  if (const std::string unit = unit_at_the_end(column); !unit.empty())
    return {column.substr(0, column.size() - unit.size() - 1), unit_of_ending(unit)};
  if (const std::size_t at = column.find('/'); at != std::string::npos)
    if (const NamedUnit found = parted(column, at, column.size());
        is_whole(found) && !is_unit(found.name))
      return found;
  return {column, ""};
}

std::string unit_of_ratio(const std::string& above, const std::string& below) {
  const bool is_word = below.find_first_of(" .*/") == std::string::npos;
  return above + (is_word ? "/" + below : "/(" + below + ")");
}

bool is_frequency_name(const std::string& column) {
  return lower_case(std::string(trimmed(column))).starts_with("freq");
}

bool is_time_name(const std::string& column) {
  static constexpr auto names = std::to_array<std::string_view>(
      {"t",          "time",         "times",        "zeit",        "timestamp",    "time stamp",
       "time_stamp", "millis",       "micros",       "elapsed",     "elapsed time", "epoch",
       "epoc",       "x_value",      "x_value_1",    "datetime",    "date time",    "uhrzeit",
       "seconds",    "milliseconds", "microseconds", "zeitstempel", "timestamps",   "utc"});
  const std::string name = lower_case(split_unit(column).name);
  const std::string all = lower_case(column);
  // "timestamp (-0700)" has a time zone in brackets.
  const std::string before = std::string(trimmed(all.substr(0, all.find_first_of("(["))));
  return std::any_of(names.begin(), names.end(), [&](const std::string_view known) {
    return name == known || before == known;
  });
}

std::string unit_of_time_name(const std::string& column) {
  const std::string name = lower_case(split_unit(column).name);
  if (name == "millis" || name == "milliseconds") return "ms";
  if (name == "micros" || name == "microseconds") return "us";
  return name == "seconds" || name == "x_value" || name == "x_value_1" ? "s" : "";
}

}  // namespace vibrissa::signals
