#include "signals/files/record_sources.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/base/unit.h"
#include "signals/formats/text/fields.h"
#include "signals/record/channel_name.h"
#include "signals/record/column_unit.h"

namespace vibrissa::signals {
namespace {

using formats::RecordTable;

/// A column of the file: its name, and the unit that the file states beside or in the name.
struct FileColumn {
  std::string name, bare_name, unit;
  bool has_unit_of_its_own = false;  // beside the name
};

std::vector<FileColumn> file_columns(const RecordTable& file) {
  std::vector<FileColumn> columns;
  const std::vector<std::string> units = file.units();
  for (std::size_t i = 0; i < file.columns().size(); ++i) {
    const std::string& name = file.columns()[i];
    NamedUnit parts = split_unit(name);
    columns.push_back(
        {name, parts.name, units[i].empty() ? parts.unit : units[i], !units[i].empty()});
  }
  return columns;
}

std::string without_spaces(std::string text) {
  std::erase(text, ' ');
  return text;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// Finds channels among the columns of one file.
class SourceFinder {
 public:
  explicit SourceFinder(const RecordTable& file) : file_(file), columns_(file_columns(file)) {}

  Sources chosen(const ReadOptions& options) const;
  std::size_t find_column(const ColumnChoice& choice) const;
  void add_channels_by_name(Sources& sources) const;
  void add_time_by_name(Sources& sources, bool needs_time, bool has_rate) const;
  void add_all_numbers(Sources& sources) const;

 private:
  std::size_t column_of(const ColumnChoice& choice) const;
  Source source_of(const ColumnChoice& choice) const;
  std::optional<Source> uncalibrated(const ColumnChoice& choice) const;
  Source by_name(const std::string& channel, std::size_t column) const;
  UnitConversion conversion(std::size_t column, const std::string& channel) const;
  Source time_source(std::size_t column, Sources& sources) const;

  const RecordTable& file_;
  std::vector<FileColumn> columns_;
};

// By the text as it stands, by the name in the file, by name and unit, or by the name without its
// unit; the number of columns where there is none.
std::size_t SourceFinder::find_column(const ColumnChoice& choice) const {
  const auto place = [&](const auto& is_it) {
    return std::size_t(std::find_if(columns_.begin(), columns_.end(), is_it) - columns_.begin());
  };
  const std::size_t n = columns_.size();
  std::size_t i = place([&](const FileColumn& column) { return column.name == choice.text; });
  if (i == n) i = place([&](const FileColumn& column) { return column.name == choice.column; });
  const std::string with_unit = without_spaces(choice.column_with_unit);
  if (i == n && !with_unit.empty())
    i = place([&](const auto& column) { return without_spaces(column.name) == with_unit; });
  const auto has_bare_name = [&](const auto& column) { return column.bare_name == choice.column; };
  if (i == n && std::count_if(columns_.begin(), columns_.end(), has_bare_name) == 1)
    i = place(has_bare_name);
  return i;
}

std::size_t SourceFinder::column_of(const ColumnChoice& choice) const {
  const std::size_t i = find_column(choice);
  if (i == columns_.size())
    throw UserError(file_.place(0) + unknown_name("column", choice.column, file_.columns()));
  return i;
}

UnitConversion SourceFinder::conversion(const std::size_t column,
                                        const std::string& channel) const {
  const FileColumn& from = columns_[column];
  const std::string to = unit_of_channel(channel);
  try {
    return convert_unit(from.unit, to);
  } catch (const UnitError&) {
    const std::string name = full_channel_name(channel);
    throw UserError(file_.place(0) + "column '" + from.name + "' is in " + from.unit +
                    ", but channel " + channel + " is in " + to +
                    "; give the calibration, as in --column '" +
                    channel.substr(0, channel.size() - unit_at_the_end(channel).size() - 1) + "=" +
                    from.bare_name + "[" + from.unit + "]*0.18[" + unit_of_ratio(to, from.unit) +
                    "]', or the unit that is right");
  }
}

// A factor other than a sign, or a unit of the choice, says how the column is converted; otherwise
// the unit of the file does.
Source SourceFinder::source_of(const ColumnChoice& choice) const {
  Source source{choice.channel, column_of(choice), choice.scale, choice.offset,
                choice.has_unit ? choice.unit : ""};
  const FileColumn& column = columns_[source.column];
  std::string unit = column.unit;
  if (unit.empty() && choice.channel == time_channel) unit = unit_of_time_name(column.name);
  const bool is_known = full_channel_name(choice.channel) == choice.channel;
  if (choice.has_unit || unit.empty() || std::abs(choice.scale) != 1. || !is_known) return source;
  // A column of dates has no unit.
  if (choice.channel == time_channel && column.unit.empty())
    source.scale *= convert_unit(unit, "s").scale;
  else {
    const UnitConversion found = conversion(source.column, choice.channel);
    source.offset = choice.scale * found.offset;
    source.scale = choice.scale * found.scale;
  }
  source.unit = unit;
  return source;
}

// A column without a factor whose unit, as the choice or else the file states it, measures another
// quantity than the channel.
std::optional<Source> SourceFinder::uncalibrated(const ColumnChoice& wanted) const {
  const std::size_t i = find_column(wanted);
  if (i == columns_.size() || wanted.has_factor) return {};
  const FileColumn& column = columns_[i];
  const std::string unit =
      wanted.unit.empty() || column.name == wanted.text ? column.unit : wanted.unit;
  if (unit.empty()) return {};
  try {
    convert_unit(unit, unit_of_channel(wanted.channel));
  } catch (const UnitError&) {
    return Source{.channel = wanted.channel, .column = i, .unit = unit, .keeps_unit = true};
  }
  return {};
}

Sources SourceFinder::chosen(const ReadOptions& options) const {
  Sources sources;
  for (const ColumnChoice& wanted : options.columns) {
    if (options.skips_missing_columns && find_column(wanted) == columns_.size()) continue;
    if (wanted.channel == options.keeps_unit_of)
      if (const auto source = uncalibrated(wanted)) {
        sources.channels.push_back(*source);
        continue;
      }
    const ColumnChoice choice = choice_in_file(wanted, file_.columns());
    assert(!choice.channel.empty() && std::isfinite(choice.scale) && choice.scale != 0.);
    const auto same = [&](const Source& other) { return other.channel == choice.channel; };
    if (sources.time && choice.channel == time_channel)
      throw UserError("two columns are chosen for time; keep one");
    if (std::any_of(sources.channels.begin(), sources.channels.end(), same))
      throw UserError("two columns are chosen for channel '" + choice.channel + "'; keep one");
    if (choice.channel == time_channel)
      sources.time = source_of(choice);
    else
      sources.channels.push_back(source_of(choice));
  }
  return sources;
}

// The name of a channel states its unit; a unit beside the name must be the same.
Source SourceFinder::by_name(const std::string& channel, const std::size_t column) const {
  const FileColumn& from = columns_[column];
  if (full_channel_name(channel) != channel || from.unit.empty()) return {channel, column};
  const UnitConversion found = conversion(column, channel);
  const bool is_same = std::abs(found.scale - 1.) < 1e-12 && found.offset == 0.;
  if (from.name == channel && !is_same)
    throw UserError(file_.place(0) + "column '" + from.name + "' has a name in " +
                    unit_of_channel(channel) + ", but the file states " + from.unit +
                    "; say which is right, as in --column '" + channel + "=" + from.name + "[" +
                    from.unit + "]'");
  if (is_same) return {channel, column};
  return {channel, column, found.scale, found.offset, from.unit};
}

/// Adds the channels that were not chosen, from columns that were not chosen; when nothing was
/// chosen, also other measured columns.
void SourceFinder::add_channels_by_name(Sources& sources) const {
  const std::vector<Source> chosen = sources.channels;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const FileColumn& column = columns_[i];
    const bool has_channel_name = full_channel_name(column.name) == column.name;
    const std::string by_bare_name = column.unit.empty() ? "" : full_channel_name(column.bare_name);
    const std::string channel =
        has_channel_name || by_bare_name.empty() ? column.name : by_bare_name;
    const bool is_time = channel == time_channel || (sources.time && sources.time->column == i);
    const bool is_channel =
        has_channel_name || !by_bare_name.empty() ||
        (chosen.empty() && ends_with_unit(column.name) && !is_time_name(column.name));
    const auto is_taken = [&](const Source& source) {
      return source.column == i || source.channel == channel;
    };
    const bool is_chosen = std::any_of(chosen.begin(), chosen.end(), is_taken) ||
                           std::any_of(sources.channels.begin(), sources.channels.end(), is_taken);
    if (!is_time && is_channel && !is_chosen) sources.channels.push_back(by_name(channel, i));
  }
}

Source SourceFinder::time_source(const std::size_t column, Sources& sources) const {
  const FileColumn& from = columns_[column];
  const std::string unit = from.unit.empty() ? unit_of_time_name(from.name) : from.unit;
  sources.time_unit_is_unknown = unit.empty();
  if (unit.empty()) return {time_channel, column};
  return {time_channel, column, convert_unit(unit, "s").scale, 0., unit};
}

// time_s, or without another clock the column with the name of a time; one that tells its unit
// first.
void SourceFinder::add_time_by_name(Sources& sources, const bool needs_time,
                                    const bool has_rate) const {
  if (sources.time) return;
  const auto is_free = [&](const std::size_t i) {
    return std::none_of(sources.channels.begin(), sources.channels.end(),
                        [&](const Source& source) { return source.column == i; });
  };
  for (std::size_t i = 0; i < columns_.size(); ++i)
    if (columns_[i].name == time_channel) sources.time = by_name(time_channel, i);
  if (sources.time || !needs_time) return;
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const FileColumn& column = columns_[i];
    if (!is_time_name(column.name) || !is_free(i)) continue;
    const bool tells_unit = !column.unit.empty() || !unit_of_time_name(column.name).empty();
    if (!column.unit.empty()) {
      try {
        convert_unit(column.unit, "s");
      } catch (const UnitError&) {
        continue;
      }
    }
    if (!found || tells_unit) found = i;
    if (tells_unit) break;
  }
  if (!found) return;
  sources.time = time_source(*found, sources);
  sources.time_is_beside_rate = has_rate;
}

/// "X_Value" of "X_Value_2", the second of two columns with one name.
std::string without_number(const std::string& name) {
  const std::size_t end = name.find_last_not_of("0123456789");
  return end != std::string::npos && end + 1 < name.size() && name[end] == '_' ? name.substr(0, end)
                                                                               : name;
}

/// Columns whose first row is a number, but times.
void SourceFinder::add_all_numbers(Sources& sources) const {
  if (file_.n_rows() == 0) return;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const bool is_time = sources.time && sources.time->column == i;
    if (columns_[i].name.empty() || is_time || is_time_name(without_number(columns_[i].name)))
      continue;
    try {
      file_.read({{&i, 1}, 1, 1});
    } catch (const UserError&) {
      continue;
    }
    sources.channels.push_back({columns_[i].name, i});
  }
}

bool rises(const formats::RecordTable& file, const std::size_t column) {
  const auto values = file.read({{&column, 1}, 1, file.n_rows()}).columns.front();
  return std::ranges::is_sorted(values);
}

// "H" of the columns H_real and H_imaginary.
std::string example_of_response(const std::vector<std::string>& columns) {
  const std::string real = "_real";
  const auto found = std::ranges::find_if(
      columns, [&](const std::string& column) { return column.ends_with(real); });
  return found == columns.end() ? "NAME" : found->substr(0, found->size() - real.size());
}

void refuse_spectrum(const formats::RecordTable& file) {
  const auto frequency = std::ranges::find_if(file.columns(), is_frequency_name);
  if (frequency == file.columns().end()) return;
  // A record with a stated rate may have a measured frequency as a channel.
  if (file.clock() && !rises(file, std::size_t(frequency - file.columns().begin()))) return;
  const std::vector<std::string> others = file.other_columns();
  throw UserError(
      file.place(0) + "this is a frequency response or a spectrum, and no record: '" + *frequency +
      "' is its frequency, and no column of its length is a time; a response is read by 'vibrissa "
      "identify --frequency-response', with --response-as '" +
      example_of_response(file.columns()) +
      "[UNIT]' where it has a name of its own. Columns: " + listed(file.columns()) +
      (others.empty() ? "" : "; of other lengths, which --column can choose: " + listed(others)));
}

// Dates and times of day are read as seconds, whatever unit is stated beside them.
void ignore_unit_of_dates(const formats::RecordTable& file, Sources& sources) {
  if (!sources.time || sources.time->unit.empty() || file.n_rows() == 0) return;
  const std::string first = file.text(1, sources.time->column);
  if (sources.time->scale == 1. || to_number(first) || !formats::time_in(first)) return;
  sources.time->scale = 1.;
  sources.time->offset = 0.;
  sources.ignored_time_unit = sources.time->unit;
}

}  // namespace

Sources find_sources(const formats::RecordTable& file, const ReadOptions& options) {
  const SourceFinder finder(file);
  Sources sources = finder.chosen(options);
  finder.add_channels_by_name(sources);
  const bool has_exact_clock = file.clock() && !file.clock_is_nominal();
  finder.add_time_by_name(sources, !has_exact_clock, options.sampling_rate_hz.has_value());
  if (!sources.time && !options.sampling_rate_hz && (!file.clock() || sources.channels.empty()))
    refuse_spectrum(file);
  ignore_unit_of_dates(file, sources);
  if (sources.channels.empty() && options.takes_all_columns) finder.add_all_numbers(sources);
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

std::string to_string(const Sources& sources, const formats::RecordTable& file) {
  std::string text;
  for (const Source& source : sources.channels) {
    const std::string& column = file.columns()[source.column];
    text.append(text.empty() ? "" : ", ").append(source.channel);
    if (column != source.channel) text.append(" = ").append(column);
    if (!source.unit.empty() && column.find(source.unit) == std::string::npos)
      text.append(" [").append(source.unit).append("]");
    if (source.scale != 1.) text.append(" * ").append(to_text(source.scale));
    if (source.offset != 0.) text.append(" + ").append(to_text(source.offset));
  }
  if (!sources.ignored_time_unit.empty())
    text.append("; '" + file.columns()[sources.time->column] + "' holds dates, so its unit '" +
                sources.ignored_time_unit + "' is not used");
  return text;
}

}  // namespace vibrissa::signals
