#include "signals/files/record_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/record/time_axis.h"

namespace vibrissa::signals {
namespace {

using formats::RecordTable;

void convert(const RecordTable& file, const Source& source, const std::size_t first_row,
             std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double raw = values[i];
    values[i] = source.scale * raw + source.offset;
    if (std::isfinite(values[i])) continue;
    throw UserError(file.place(first_row + i) + "column '" + file.columns()[source.column] +
                    "': '" + file.text(first_row + i, source.column) + "' is not finite" +
                    (std::isfinite(raw) ? " after scaling" : "") +
                    "; missing samples are never filled in: choose rows without missing samples");
  }
}

// Hint for a time column in ms or us that is declared in seconds.
std::string time_unit_hint(const double ratio) {
  const auto near = [&](const double factor) { return std::abs(ratio / factor - 1.) < 1e-2; };
  if (near(1e3)) return "; the column seems to be in ms";
  return near(1e6) ? "; the column seems to be in us" : "";
}

// Time axis of a time column; a rate that is also given must agree and is then used.
TimeAxis axis_of_column(const RecordTable& file, const std::string& path, const Source& time,
                        const std::vector<double>& times_s, const TimeDigits& digits,
                        const ReadOptions& options) {
  const RecordTable::RowNames names = file.row_names();
  TimeAxis axis = find_time_axis({.times_s = times_s,
                                  .digits = digits,
                                  .unit_s = time.scale,
                                  .file = path,
                                  .first_line = options.first_row + names.offset,
                                  .column = file.columns()[time.column],
                                  .row_word = names.word});
  const auto stated = file.clock();
  const std::optional<double> known = options.sampling_rate_hz ? options.sampling_rate_hz
                                      : stated ? std::optional(stated->sampling_rate_hz)
                                               : std::nullopt;
  if (!known) return axis;
  if (std::abs(*known - axis.sampling_rate_hz) > 1e-3 * axis.sampling_rate_hz)
    throw UserError(path + ": the given sampling rate " + to_text(*known) +
                    " Hz contradicts column '" + file.columns()[time.column] + "', which gives " +
                    to_text(axis.sampling_rate_hz) +
                    " Hz; correct the rate (--rate, or sampling_rate_hz in dataset.json or in the "
                    "file) or the column" +
                    time_unit_hint(*known / axis.sampling_rate_hz));
  axis.sampling_rate_hz = *known;
  return axis;
}

TimeAxis axis_without_column(const RecordTable& file, const ReadOptions& options) {
  const TimeAxis stated = file.clock().value_or(TimeAxis{0., 0.});
  const double rate = options.sampling_rate_hz.value_or(stated.sampling_rate_hz);
  return {stated.start_s + static_cast<double>(options.first_row - 1) / rate, rate};
}

}  // namespace

void check(const ReadOptions& options) {
  if (const auto rate = options.sampling_rate_hz; rate && !(std::isfinite(*rate) && *rate > 0.))
    throw UserError("--rate " + to_text(*rate) +
                    ": the sampling rate must be a positive number of Hz");
}

std::size_t number_of_rows(const RecordTable& file, const ReadOptions& options) {
  const std::size_t there = file.n_rows();
  if (options.first_row == 0) throw UserError("the first row has the number 1, not 0");
  const std::size_t skipped = options.first_row - 1;
  const std::size_t left = there - std::min(there, skipped);
  const std::size_t count = options.n_rows.value_or(left);
  if (skipped > there || count > left)
    throw UserError(file.place(there) + "rows " + std::to_string(options.first_row) + " to " +
                    (options.n_rows ? std::to_string(skipped + count) : "the last") +
                    " are requested, but the file has " + std::to_string(there) + " rows");
  if (count < least_samples)
    throw UserError(file.place(there) + "only " + std::to_string(count) +
                    " samples; a record needs at least " + std::to_string(least_samples));
  return count;
}

Record read_rows(const RecordTable& file, const std::string& path, const Sources& sources,
                 const ReadOptions& options, const std::size_t n_rows) {
  std::vector<Source> wanted = sources.channels;
  if (sources.time) wanted.push_back(*sources.time);
  std::vector<std::size_t> columns;
  for (const Source& source : wanted) columns.push_back(source.column);
  const auto time_column = sources.time ? std::optional(sources.time->column) : std::nullopt;
  auto [values, digits] = file.read({columns, options.first_row, n_rows, time_column});
  for (std::size_t c = 0; c < values.size(); ++c)
    convert(file, wanted[c], options.first_row, values[c]);
  const TimeAxis axis =
      sources.time ? axis_of_column(file, path, *sources.time, values.back(), digits, options)
                   : axis_without_column(file, options);
  Record record(axis.sampling_rate_hz, n_rows, axis.start_s);
  for (std::size_t c = 0; c < sources.channels.size(); ++c)
    record.set_channel(sources.channels[c].channel, std::move(values[c]));
  return record;
}

}  // namespace vibrissa::signals
