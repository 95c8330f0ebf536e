#include "signals/files/record_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/base/significant_digits.h"
#include "signals/files/resampled_rows.h"
#include "signals/record/time_axis.h"

namespace vibrissa::signals {
namespace {

using formats::ColumnValues;
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

// Whole numbers may count ms, us or ticks.
void check_time_unit(const RecordTable& file, const Source& time, const std::size_t first_row,
                     const std::vector<double>& times) {
  const bool are_whole =
      std::all_of(times.begin(), times.end(), [](const double t) { return t == std::floor(t); });
  const std::string first = file.text(first_row, time.column);
  if (!are_whole || first.find_first_of(":T") != std::string::npos) return;
  const std::string& name = file.columns()[time.column];
  throw UserError(file.place(0) + "the unit of the time column '" + name +
                  "' is not known, because its numbers are whole; give it, as in --column 'time=" +
                  name + "[ms]' or 'time=" + name + "[s]'");
}

// First rows of the recordings of the file within the rows, from 0.
std::vector<std::size_t> blocks_within(const RecordTable& file, const std::size_t first_row,
                                       const std::size_t n_rows) {
  std::vector<std::size_t> starts;
  for (const std::size_t row : file.block_starts())
    if (row > first_row && row < first_row + n_rows) starts.push_back(row - first_row);
  return starts;
}

// A rate that is given, or that the file states exactly, must agree with the stamps and is used.
void settle_rate(const RecordTable& file, const std::string& path, const std::string& column,
                 const ReadOptions& options, Clock& clock) {
  const auto stated = file.clock();
  std::optional<double> known = options.sampling_rate_hz;
  if (!known && stated) known = stated->sampling_rate_hz;
  if (!known) return;
  const bool is_nominal = !options.sampling_rate_hz && file.clock_is_nominal();
  const double allowed = is_nominal ? 0.2 : 1e-3;
  if (std::abs(*known - clock.sampling_rate_hz) > allowed * clock.sampling_rate_hz)
    throw UserError(path + ": the " + (is_nominal ? "stated" : "given") + " sampling rate " +
                    to_text(*known) + " Hz contradicts column '" + column + "', which gives " +
                    rate_text(clock.sampling_rate_hz) +
                    "; correct the rate (--rate, or sampling_rate_hz in dataset.json or in the "
                    "file) or the column" +
                    time_unit_hint(*known / clock.sampling_rate_hz));
  if (!is_nominal) clock.sampling_rate_hz = *known;
}

// Times since 1970 need more digits than a double has: they begin anew at the first row. Returns
// what was subtracted.
double begin_at_zero(std::vector<double>& times_s) {
  constexpr double long_ago_s = 1e8;
  const double start = times_s.front();
  if (std::abs(start) < long_ago_s) return 0.;
  for (double& time : times_s) time -= start;
  return start;
}

Clock clock_of_column(const RecordTable& file, const std::string& path, const Sources& sources,
                      std::vector<double>& times_s, const TimeDigits& digits,
                      const ReadOptions& options) {
  const Source& time = *sources.time;
  if (sources.time_unit_is_unknown) check_time_unit(file, time, options.first_row, times_s);
  const double epoch_s = begin_at_zero(times_s);
  const PrintedTimes printed{
      .times_s = times_s,
      .digits = digits,
      .unit_s = time.scale,
      .file = path,
      .first_line = file.row_number(options.first_row),
      .column = file.columns()[time.column],
      .row_word = file.row_word(),
      .line_of = [&](const std::size_t i) { return file.row_number(options.first_row + i); }};
  Clock clock = find_clock(printed, blocks_within(file, options.first_row, times_s.size()));
  clock.epoch_s = epoch_s;
  settle_rate(file, path, printed.column, options, clock);
  if (options.gaps == Gaps::pieces || clock.pieces.size() == 1) return clock;
  find_time_axis(printed);  // names a gap of an exact grid
  refuse_lost_samples(printed, clock);
  return clock;
}

// Without stamps every block begins at the stated start.
Clock clock_without_column(const RecordTable& file, const std::string& path,
                           const ReadOptions& options, const std::size_t n_rows) {
  const TimeAxis stated = file.clock().value_or(TimeAxis{0., 0.});
  Clock clock;
  clock.sampling_rate_hz = options.sampling_rate_hz.value_or(stated.sampling_rate_hz);
  clock.words = rate_text(clock.sampling_rate_hz);
  std::vector<std::size_t> starts = blocks_within(file, options.first_row, n_rows);
  if (!starts.empty() && options.gaps == Gaps::refuse)
    throw UserError(path + ": contains " + std::to_string(starts.size() + 1) +
                    " recordings, the second from " + file.row_word() + " " +
                    std::to_string(file.row_number(options.first_row + starts.front())) +
                    " on; choose one by --rows");
  starts.insert(starts.begin(), 0);
  starts.push_back(n_rows);
  for (std::size_t p = 0; p + 1 < starts.size(); ++p)
    clock.pieces.push_back({starts[p], starts[p + 1] - starts[p], stated.start_s});
  clock.pieces.front().start_s += double(options.first_row - 1) / clock.sampling_rate_hz;
  if (clock.pieces.size() > 1)
    clock.words += "; " + std::to_string(clock.pieces.size()) + " recordings in the file";
  return clock;
}

std::vector<Record> records_of(const Sources& sources, const Clock& clock,
                               std::vector<std::vector<double>>& values) {
  std::vector<Record> records;
  for (const ClockPiece& piece : clock.pieces) {
    if (piece.count < least_samples) continue;
    records.emplace_back(clock.sampling_rate_hz, piece.count, piece.start_s);
    const bool is_all = clock.pieces.size() == 1;
    for (std::size_t c = 0; c < sources.channels.size(); ++c) {
      const auto begin = values[c].begin() + std::ptrdiff_t(piece.first);
      records.back().set_channel(
          sources.channels[c].channel,
          is_all ? std::move(values[c])
                 : std::vector<double>(begin, begin + std::ptrdiff_t(piece.count)));
    }
  }
  return records;
}

}  // namespace

void check(const ReadOptions& options) {
  if (const auto rate = options.sampling_rate_hz; rate && !(std::isfinite(*rate) && *rate > 0.))
    throw UserError("--rate " + to_text(*rate) +
                    ": the sampling rate must be a positive number of Hz");
  if (const auto rate = options.resample_hz; rate && !(std::isfinite(*rate) && *rate > 0.))
    throw UserError("--resample " + to_text(*rate) + ": the rate must be a positive number of Hz");
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

Clock read_clock(const RecordTable& file, const std::string& path, const Sources& sources,
                 const ReadOptions& options, const std::size_t n_rows) {
  if (!sources.time) return clock_without_column(file, path, options, n_rows);
  const std::size_t column = sources.time->column;
  auto [values, digits] = file.read({{&column, 1}, options.first_row, n_rows, column});
  convert(file, *sources.time, options.first_row, values.front());
  return clock_of_column(file, path, sources, values.front(), digits, options);
}

std::vector<Record> read_rows(const RecordTable& file, const std::string& path,
                              const Sources& sources, const ReadOptions& options,
                              const std::size_t n_rows, std::optional<Clock>& clock) {
  std::vector<Source> wanted = sources.channels;
  const bool reads_time = sources.time && !clock;
  if (reads_time) wanted.push_back(*sources.time);
  std::vector<std::size_t> columns;
  for (const Source& source : wanted) columns.push_back(source.column);
  const auto time_column = reads_time ? std::optional(sources.time->column) : std::nullopt;
  auto [values, digits] = file.read({columns, options.first_row, n_rows, time_column});
  for (std::size_t c = 0; c < values.size(); ++c)
    convert(file, wanted[c], options.first_row, values[c]);
  if (options.resample_hz && !sources.time)
    throw UserError(path +
                    ": --resample is for uneven stamps, and this file has a rate and no stamps; "
                    "leave it out");
  if (options.resample_hz && reads_time) {
    if (sources.time_unit_is_unknown)
      check_time_unit(file, *sources.time, options.first_row, values.back());
    const double epoch_s = begin_at_zero(values.back());
    std::vector<Record> even =
        resampled_records(path, sources, values, *options.resample_hz, clock);
    clock->epoch_s = epoch_s;
    return even;
  }
  if (!clock)
    clock = reads_time ? clock_of_column(file, path, sources, values.back(), digits, options)
                       : clock_without_column(file, path, options, n_rows);
  std::vector<Record> records = records_of(sources, *clock, values);
  if (records.empty())
    throw UserError(path + ": " + clock->words + "; none of the " +
                    std::to_string(clock->pieces.size()) + " pieces between them has " +
                    std::to_string(least_samples) + " samples, which a record needs");
  return records;
}

}  // namespace vibrissa::signals
