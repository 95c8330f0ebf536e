#include "signals/record_io.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "signals/csv_file.h"
#include "signals/error.h"
#include "signals/number_text.h"
#include "signals/output_file.h"
#include "signals/time_axis.h"

namespace vibrissa::signals {
namespace {

constexpr std::size_t least_samples = 64;
const std::string time_name = "time_s";

// In the order in which a record is written; the others follow alphabetically.
const std::vector<std::string>& leading_channels() {
  static const std::vector<std::string> names = {channel::base_acceleration,
                                                 channel::cross_acceleration, channel::wind_speed,
                                                 channel::base_moment};
  return names;
}

const std::vector<std::string>& known_channels() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = leading_channels();
    for (const char* const further :
         {"cross_moment_N_m", "base_acceleration_2_m_s2", "coil_current_A", "temperature_C"})
      all.emplace_back(further);
    all.push_back(time_name);
    return all;
  }();
  return names;
}

// Ends of column names that say "this is a measured quantity", not the text or counter of a logger.
bool ends_with_unit(const std::string& name) {
  static constexpr auto units = std::to_array<std::string_view>(
      {"s",     "ms",    "us",    "Hz",    "m",      "mm",     "um",  "m_s",  "mps",
       "mm_s",  "m_s2",  "mps2",  "mm_s2", "g",      "mg",     "rad", "mrad", "deg",
       "rad_s", "radps", "deg_s", "dps",   "rad_s2", "N",      "mN",  "uN",   "N_m",
       "mN_m",  "uN_m",  "Nm",    "mNm",   "Nmm",    "uNm",    "Pa",  "hPa",  "kPa",
       "bar",   "A",     "mA",    "V",     "mV",     "uV",     "T",   "mT",   "uT",
       "C",     "K",     "kg",    "kg_m3", "W",      "percent"});
  return std::any_of(units.begin(), units.end(), [&](const std::string_view unit) {
    return name.size() > unit.size() + 1 && name.ends_with(unit) &&
           name[name.size() - unit.size() - 1] == '_';
  });
}

bool is_known(const std::string& channel) {
  return std::find(known_channels().begin(), known_channels().end(), channel) !=
         known_channels().end();
}

// Empty when no channel has this name, with or without its unit.
std::string full_channel_name(const std::string& name) {
  if (is_known(name)) return name;
  for (const std::string& known : known_channels())
    for (const std::string_view unit : {"_m_s2", "_m_s", "_N_m", "_A", "_C", "_s"})
      if (known == name + std::string(unit)) return known;
  return {};
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

double parse_scale(const std::string& text, const std::string& choice) {
  const std::optional<double> scale = to_number(text);
  if (!scale || !std::isfinite(*scale) || *scale == 0.)
    throw UserError("column choice '" + choice + "': the scale '" + text +
                    "' must be a finite number other than 0");
  return *scale;
}

// A column of the file that becomes a channel.
struct Source {
  std::string channel;
  std::size_t column;
  double scale = 1.;
};

struct Sources {
  std::vector<Source> channels;
  std::optional<Source> time;
};

Sources chosen_sources(const CsvFile& file, const std::vector<ColumnChoice>& choices) {
  Sources sources;
  for (const ColumnChoice& choice : choices) {
    assert(!choice.channel.empty() && std::isfinite(choice.scale) && choice.scale != 0.);
    const Source source = {choice.channel, file.index_of(choice.column), choice.scale};
    const auto same = [&](const Source& other) { return other.channel == source.channel; };
    if (sources.time && source.channel == time_name)
      throw UserError("two columns are chosen for time");
    if (std::any_of(sources.channels.begin(), sources.channels.end(), same))
      throw UserError("two columns are chosen for channel '" + source.channel + "'; keep one");
    if (source.channel == time_name)
      sources.time = source;
    else
      sources.channels.push_back(source);
  }
  return sources;
}

std::vector<Source> channels_by_name(const CsvFile& file, const std::optional<Source>& time) {
  std::vector<Source> channels;
  for (std::size_t i = 0; i < file.columns().size(); ++i) {
    const std::string& name = file.columns()[i];
    const bool is_time = name == time_name || (time && time->column == i);
    if (!is_time && (is_known(name) || ends_with_unit(name))) channels.push_back({name, i});
  }
  return channels;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

Sources find_sources(const CsvFile& file, const ReadOptions& options) {
  const bool by_name = std::all_of(options.columns.begin(), options.columns.end(),
                                   [](const auto& choice) { return choice.channel == time_name; });
  Sources sources = chosen_sources(file, options.columns);
  if (by_name) sources.channels = channels_by_name(file, sources.time);
  if (!sources.time && file.has(time_name)) sources.time = {time_name, file.index_of(time_name)};
  if (sources.channels.empty())
    throw UserError(file.place(1) +
                    "no column has the name of a channel (quantity_unit); say which columns to "
                    "take, as in --column base_moment=hall_mT*1.8e-4. Columns: " +
                    listed(file.columns()));
  if (!sources.time && !options.sampling_rate_hz)
    throw UserError(file.place(1) +
                    "no column time_s, so the sampling rate is unknown: give --rate in Hz, or the "
                    "column of time as in --column time=t_ms*1e-3. Columns: " +
                    listed(file.columns()));
  return sources;
}

std::size_t number_of_rows(const CsvFile& file, const ReadOptions& options) {
  const std::size_t there = file.n_rows();
  if (options.first_row == 0) throw UserError("the first row is row 1, not row 0");
  const std::size_t skipped = options.first_row - 1;
  const std::size_t left = there - std::min(there, skipped);
  const std::size_t count = options.n_rows.value_or(left);
  if (skipped > there || count > left)
    throw UserError(file.place(there + 1) + "rows " + std::to_string(options.first_row) + " to " +
                    (options.n_rows ? std::to_string(skipped + count) : "the last") +
                    " are asked for, but the file has " + std::to_string(there) + " rows");
  if (count < least_samples)
    throw UserError(file.place(there + 1) + "only " + std::to_string(count) +
                    " samples; a record needs at least " + std::to_string(least_samples));
  return count;
}

std::string shortened(const std::string_view text) {
  constexpr std::size_t most = 40;
  return std::string(text.substr(0, most)) + (text.size() > most ? "..." : "");
}

double read_number(const CsvFile& file, const std::size_t line, const Source& source,
                   const std::string_view field) {
  const auto refuse = [&](const std::string& what) {
    throw UserError(file.place(line) + "column '" + file.columns()[source.column] + "': " + what);
  };
  const std::optional<double> number = to_number(field);
  if (!number)
    refuse(field.empty() ? "the field is empty" : "'" + shortened(field) + "' is no number");
  const double value = source.scale * *number;
  if (!std::isfinite(value))
    refuse("'" + shortened(field) + "' is not finite" +
           (std::isfinite(*number) ? " once scaled" : "") +
           "; missing samples are never filled in: choose rows without any");
  return value;
}

struct Samples {
  std::vector<std::vector<double>> channels;
  std::vector<double> times_s;
  TimeDigits time_digits;
};

Samples read_samples(const CsvFile& file, const Sources& sources, const std::size_t first_row,
                     const std::size_t n_rows) {
  Samples samples;
  samples.channels.assign(sources.channels.size(), std::vector<double>(n_rows));
  if (sources.time) samples.times_s.resize(n_rows);
  std::size_t i = 0;
  const auto read_row = [&](const std::size_t line,
                            const std::span<const std::string_view> fields) {
    for (std::size_t c = 0; c < sources.channels.size(); ++c) {
      const Source& source = sources.channels[c];
      samples.channels[c][i] = read_number(file, line, source, fields[source.column]);
    }
    if (sources.time) {
      const std::string_view time = fields[sources.time->column];
      samples.times_s[i] = read_number(file, line, *sources.time, time);
      samples.time_digits.see(time);
    }
    ++i;
  };
  file.for_each_row(first_row, n_rows, read_row);
  return samples;
}

// A column of time in thousandths or millionths of a second, called seconds.
std::string time_unit_hint(const double ratio) {
  const auto near = [&](const double factor) { return std::abs(ratio / factor - 1.) < 1e-2; };
  if (near(1e3)) return "; the column seems to be in ms";
  return near(1e6) ? "; the column seems to be in us" : "";
}

TimeAxis time_axis_of(const CsvFile& file, const std::string& path, const Sources& sources,
                      const Samples& samples, const ReadOptions& options) {
  const std::optional<double> given = options.sampling_rate_hz;
  if (!sources.time) return {static_cast<double>(options.first_row - 1) / *given, *given};
  TimeAxis axis = find_time_axis({.times_s = samples.times_s,
                                  .digits = samples.time_digits,
                                  .unit_s = sources.time->scale,
                                  .file = path,
                                  .first_line = options.first_row + 1,
                                  .column = file.columns()[sources.time->column]});
  if (!given) return axis;
  if (std::abs(*given - axis.sampling_rate_hz) > 1e-3 * axis.sampling_rate_hz)
    throw UserError(
        path + ": the rate " + to_text(*given) + " Hz that was given contradicts column '" +
        file.columns()[sources.time->column] + "', which says " + to_text(axis.sampling_rate_hz) +
        " Hz; correct it (--rate, or " + "sampling_rate_hz in dataset.json) or the column" +
        time_unit_hint(*given / axis.sampling_rate_hz));
  axis.sampling_rate_hz = *given;
  return axis;
}

std::vector<std::string> channels_in_writing_order(const Record& record) {
  std::vector<std::string> names;
  const std::vector<std::string>& leading = leading_channels();
  for (const std::string& name : leading)
    if (record.has(name)) names.push_back(name);
  for (const std::string& name : record.channel_names())
    if (std::find(leading.begin(), leading.end(), name) == leading.end()) names.push_back(name);
  return names;
}

std::string csv_field(const std::string& name) {
  if (name.find_first_of(",\"") == std::string::npos && name == trimmed(name)) return name;
  std::string quoted = "\"";
  for (const char c : name) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

void write_rows(std::ostream& out, const Record& record, const std::vector<std::string>& names) {
  std::vector<std::span<const double>> channels;
  for (const std::string& name : names) channels.push_back(record.channel(name));
  std::string row;
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    row = to_text(record.time_s(i));
    for (const auto& values : channels) row.append(1, ',').append(to_text(values[i]));
    out << row.append(1, '\n');
  }
}

}  // namespace

ColumnChoice parse_column_choice(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos)
    throw UserError("column choice '" + text +
                    "': expected channel=column or channel=column*scale");
  const std::string name = trimmed(text.substr(0, equals));
  ColumnChoice choice;
  choice.channel = full_channel_name(name);
  if (choice.channel.empty())
    throw UserError("column choice '" + text +
                    "': " + unknown_name("channel", name, known_channels()));
  const std::string rest = text.substr(equals + 1);
  const auto star = rest.rfind('*');
  choice.column = trimmed(rest.substr(0, star));
  if (choice.column.empty())
    throw UserError("column choice '" + text + "': the name of the column is missing after '='");
  if (star != std::string::npos) choice.scale = parse_scale(trimmed(rest.substr(star + 1)), text);
  return choice;
}

Record read_record(const std::filesystem::path& file, const ReadOptions& options) {
  if (const auto rate = options.sampling_rate_hz; rate && !(std::isfinite(*rate) && *rate > 0.))
    throw UserError("--rate " + to_text(*rate) +
                    ": the sampling rate must be a positive number of Hz");
  const CsvFile csv(file);
  const Sources sources = find_sources(csv, options);
  const std::size_t n_rows = number_of_rows(csv, options);
  Samples samples = read_samples(csv, sources, options.first_row, n_rows);
  const TimeAxis axis = time_axis_of(csv, file.string(), sources, samples, options);
  Record record(axis.sampling_rate_hz, n_rows, axis.start_s);
  for (std::size_t c = 0; c < sources.channels.size(); ++c)
    record.set_channel(sources.channels[c].channel, std::move(samples.channels[c]));
  return record;
}

void write_record(const std::filesystem::path& file, const Record& record) {
  const std::vector<std::string> names = channels_in_writing_order(record);
  write_file(file, [&](std::ostream& out) {
    out << time_name;
    for (const std::string& name : names) out << ',' << csv_field(name);
    out << '\n';
    write_rows(out, record, names);
  });
}

}  // namespace vibrissa::signals
