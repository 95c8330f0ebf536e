#include "signals/formats/text/labview_layout.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/base/utf_8.h"
#include "signals/formats/text/head_parts.h"
#include "signals/record/time_axis.h"

namespace vibrissa::signals::formats {
namespace {

struct LabviewHeader {
  std::map<std::string, std::vector<std::string>> entries = {};
  std::map<std::string, std::size_t> lines = {};
  const HeadLine* names = nullptr;
  const HeadLine* first_row = nullptr;

  std::string entry(const std::string& key) const {
    const auto found = entries.find(key);
    return found == entries.end() || found->second.empty() ? "" : found->second.front();
  }
};

LabviewHeader labview_header(const std::vector<HeadLine>& head, const char separator) {
  LabviewHeader header;
  for (std::size_t i = 0; i < head.size(); ++i) {
    const auto fields = split_line(head[i].text, separator);
    const std::string key(fields.front());
    if (key == "X_Value") {
      header.names = &head[i];
      header.first_row = i + 1 < head.size() ? &head[i + 1] : nullptr;
      return header;
    }
    header.lines[key] = head[i].number;
    header.entries[key] = {fields.begin() + 1, fields.end()};
  }
  return header;
}

std::vector<std::string> units_of(const LabviewHeader& header, const std::size_t n_columns,
                                  const std::vector<std::string_view>& names) {
  std::vector<std::string> units(n_columns);
  const auto found = header.entries.find("Y_Unit_Label");
  for (std::size_t i = 0; i < n_columns && i < names.size(); ++i) {
    if (names[i] == "X_Value" && header.entry("X_Dimension") == "Time") units[i] = "s";
    if (names[i] == "X_Value" || names[i] == "Comment" || found == header.entries.end()) continue;
    // The entries stand in the columns of the channels, of which the key takes the first.
    if (i >= 1 && i - 1 < found->second.size()) units[i] = as_utf_8(found->second[i - 1]);
  }
  return units;
}

// The rate with the fewest digits that the rounded step allows; the nearest one of these.
double rate_of_step(const double step_s, const std::string& text) {
  TimeDigits digits;
  digits.see(text);
  const double half = digits.rounding(step_s);
  const double lowest = 1. / (step_s + half), highest = 1. / std::max(step_s - half, step_s / 2.);
  const double exact = 1. / step_s;
  for (double place = std::pow(10., std::floor(std::log10(exact))); place > 1e-9; place /= 10.) {
    const double rate = std::round(exact / place) * place;
    if (rate >= lowest && rate <= highest) return rate;
  }
  return exact;
}

/// What the header states of one channel.
struct ChannelClock {
  std::size_t column = 0;
  double step_s = 0.;
  std::string step;  // as printed, with a point
  double start_s = 0.;
  std::optional<std::size_t> n_samples;
};

std::string entry_of(const LabviewHeader& header, const std::string& key, const std::size_t i) {
  const auto found = header.entries.find(key);
  return found == header.entries.end() || i >= found->second.size() ? "" : found->second[i];
}

// The key takes the first column, so the entries of a channel stand in its column.
std::vector<ChannelClock> channel_clocks(const LabviewHeader& header, const char decimal) {
  std::vector<ChannelClock> clocks;
  const auto found = header.entries.find("Delta_X");
  if (found == header.entries.end()) return clocks;
  for (std::size_t i = 0; i < found->second.size(); ++i) {
    std::string text = found->second[i];
    const std::string samples = entry_of(header, "Samples", i);
    const auto value = number_in(text, decimal);
    if (text.empty() || samples == "0" || !value || !(*value > 0.)) continue;
    std::replace(text.begin(), text.end(), ',', '.');
    ChannelClock clock{i + 1, *value, text, 0., {}};
    clock.start_s = number_in(entry_of(header, "X0", i), decimal).value_or(0.);
    if (const auto n = to_number(samples); n && *n >= 1. && *n < 1e12)
      clock.n_samples = static_cast<std::size_t>(*n);
    clocks.push_back(clock);
  }
  return clocks;
}

bool have_one_step(const std::vector<ChannelClock>& clocks) {
  return std::all_of(clocks.begin(), clocks.end(), [&](const ChannelClock& clock) {
    return clock.step_s == clocks.front().step_s;
  });
}

std::optional<StatedRate> labview_rate(const LabviewHeader& header,
                                       const std::vector<ChannelClock>& clocks,
                                       const char decimal) {
  if (clocks.empty() || !have_one_step(clocks)) return {};
  const auto start = number_in(header.entry("X0"), decimal);
  return StatedRate{rate_of_step(clocks.front().step_s, clocks.front().step), start.value_or(0.),
                    "Delta_X in line " + std::to_string(header.lines.at("Delta_X")),
                    header.entry("X_Columns") == "No"};
}

std::vector<RateGroup> rate_groups(const std::string& file, const LabviewHeader& header,
                                   const std::vector<ChannelClock>& clocks,
                                   const std::size_t n_columns) {
  std::vector<RateGroup> groups;
  if (clocks.empty() || have_one_step(clocks)) return groups;
  for (const ChannelClock& clock : clocks) {
    if (clock.column >= n_columns) continue;
    if (!clock.n_samples)
      throw UserError(file + ":" + std::to_string(header.lines.at("Delta_X")) +
                      ": the channels have different steps (" + clocks.front().step +
                      " s, ...), "
                      "but no line Samples says how many each has; export each rate to its own "
                      "file");
    const TimeAxis axis{clock.start_s, rate_of_step(clock.step_s, clock.step)};
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const RateGroup& group) {
      return group.clock.sampling_rate_hz == axis.sampling_rate_hz &&
             group.clock.start_s == axis.start_s && group.n_rows == *clock.n_samples;
    });
    if (same == groups.end())
      groups.push_back({{clock.column}, axis, *clock.n_samples});
    else
      same->columns.push_back(clock.column);
  }
  return groups;
}

}  // namespace

bool is_labview(const std::vector<HeadLine>& head) {
  return !head.empty() && head.front().text.starts_with("LabVIEW Measurement");
}

bool begins_labview_header(const std::string_view line) {
  return line.starts_with("Channels") || line.starts_with("LabVIEW Measurement") ||
         line.starts_with("Notes") || line.starts_with("***");
}

bool ends_labview_header(const std::string_view line) {
  return line.starts_with("X_Value");
}

TableLayout labview_layout(const std::string& file, const std::vector<HeadLine>& head,
                           const TextOptions& options) {
  TableLayout layout;
  layout.is_labview = true;
  const bool has_commas = std::any_of(head.begin(), head.end(), [](const HeadLine& line) {
    return line.text.starts_with("Separator,Comma") || line.text.starts_with("Separator,,");
  });
  const char separator = options.separator.value_or(has_commas ? ',' : '\t');
  const LabviewHeader header = labview_header(head, separator);
  if (header.names == nullptr)
    throw UserError(file +
                    ": the LabVIEW header has no line that begins with X_Value, so the "
                    "columns have no names; give --header-lines");
  const auto names = split_line(header.names->text, separator);
  std::size_t n_columns = names.size();
  while (n_columns > 1 && names[n_columns - 1].empty()) --n_columns;
  const bool step_has_comma = header.entry("X0").find(',') != std::string::npos && separator != ',';
  const bool has_comma = header.entries.count("Decimal_Separator") != 0
                             ? header.entry("Decimal_Separator") == ","
                             : step_has_comma;
  layout.spelling = {separator, options.decimal.value_or(has_comma ? ',' : '.')};
  layout.names = column_names(names, n_columns);
  layout.units = units_of(header, n_columns, names);
  layout.line_of_names = header.names->number;
  const auto units = header.lines.find("Y_Unit_Label");
  if (units != header.lines.end()) layout.line_of_units = units->second;
  layout.last_is_optional = names[n_columns - 1] == "Comment";
  layout.n_fields = n_columns;
  layout.first_line = header.names->number + 1;
  layout.first_at = header.first_row != nullptr ? header.first_row->at
                                                : header.names->at + header.names->text.size() + 1;
  const auto clocks = channel_clocks(header, layout.spelling.decimal);
  layout.rate = labview_rate(header, clocks, layout.spelling.decimal);
  layout.rate_groups = rate_groups(file, header, clocks, n_columns);
  if (const auto samples = to_number(header.entry("Samples")); samples && *samples >= 1.)
    layout.rows_a_block = static_cast<std::size_t>(std::min(*samples, 1e12));
  for (const RateGroup& group : layout.rate_groups) {
    layout.rows_a_block = std::max(layout.rows_a_block, group.n_rows);
    layout.n_fields = 1;  // slower channels end before the others
    layout.last_is_optional = false;
  }
  return layout;
}

}  // namespace vibrissa::signals::formats
