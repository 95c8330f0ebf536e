#include "signals/files/record_sources.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "signals/base/error.h"
#include "signals/record/channel_name.h"

namespace vibrissa::signals {
namespace {

std::optional<std::size_t> find_column(const formats::RecordTable& file, const std::string& name) {
  const auto& names = file.columns();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return {};
  return static_cast<std::size_t>(found - names.begin());
}

std::string without_spaces(std::string text) {
  std::erase(text, ' ');
  return text;
}

// Finds a column by its name or, when a header contains units, by name and unit.
std::size_t column_of(const formats::RecordTable& file, const ColumnChoice& choice) {
  if (const auto column = find_column(file, choice.column)) return *column;
  const std::string with_unit = without_spaces(choice.column_with_unit);
  for (std::size_t i = 0; !with_unit.empty() && i < file.columns().size(); ++i)
    if (without_spaces(file.columns()[i]) == with_unit) return i;
  throw UserError(file.place(0) + unknown_name("column", choice.column, file.columns()));
}

Sources chosen_sources(const formats::RecordTable& file, const std::vector<ColumnChoice>& choices) {
  Sources sources;
  for (const ColumnChoice& choice : choices) {
    assert(!choice.channel.empty() && std::isfinite(choice.scale) && choice.scale != 0.);
    const Source source = {choice.channel, column_of(file, choice), choice.scale, choice.offset};
    const auto same = [&](const Source& other) { return other.channel == source.channel; };
    if (sources.time && source.channel == time_channel)
      throw UserError("two columns are chosen for time; keep one");
    if (std::any_of(sources.channels.begin(), sources.channels.end(), same))
      throw UserError("two columns are chosen for channel '" + source.channel + "'; keep one");
    if (source.channel == time_channel)
      sources.time = source;
    else
      sources.channels.push_back(source);
  }
  return sources;
}

/// Adds the channels that were not chosen, from columns that were not chosen; when nothing was
/// chosen, also other measured columns.
void add_channels_by_name(const formats::RecordTable& file, Sources& sources) {
  const std::vector<Source> chosen = sources.channels;
  for (std::size_t i = 0; i < file.columns().size(); ++i) {
    const std::string& name = file.columns()[i];
    const bool is_time = name == time_channel || (sources.time && sources.time->column == i);
    const bool is_channel =
        full_channel_name(name) == name || (chosen.empty() && ends_with_unit(name));
    const bool is_chosen = std::any_of(chosen.begin(), chosen.end(), [&](const Source& source) {
      return source.column == i || source.channel == name;
    });
    if (!is_time && is_channel && !is_chosen) sources.channels.push_back({name, i});
  }
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

Sources find_sources(const formats::RecordTable& file, const ReadOptions& options) {
  Sources sources = chosen_sources(file, options.columns);
  add_channels_by_name(file, sources);
  if (const auto time = find_column(file, time_channel); time && !sources.time)
    sources.time = {time_channel, *time};
  if (sources.channels.empty())
    throw UserError(
        file.place(0) +
        "no column has the name of a channel (quantity_unit); name the columns and their units, as "
        "in --column 'base_moment=hall[mN mm]' or base_moment=hall_mT*1.8e-4. Columns: " +
        listed(file.columns()));
  if (!sources.time && !options.sampling_rate_hz && !file.clock())
    throw UserError(
        file.place(0) +
        "the sampling rate is unknown, because the file has no column time_s: give --rate in Hz, "
        "or name the time column, as in --column 'time=t[ms]'. Columns: " +
        listed(file.columns()));
  return sources;
}

}  // namespace vibrissa::signals
