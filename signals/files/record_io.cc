#include "signals/files/record_io.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/files/file_format.h"
#include "signals/files/record_rows.h"
#include "signals/files/record_sources.h"
#include "signals/files/several_rates.h"
#include "signals/record/channel_name.h"
#include "signals/spectra/resample.h"

namespace vibrissa::signals {
namespace {

using formats::RecordTable;

void remove_means(const ReadOptions& options, Record& record) {
  for (const std::string& name : options.remove_mean) {
    const std::string channel = full_channel_name(name);
    if (channel.empty()) throw UserError(unknown_name("channel", name, known_channels()));
    record.set_channel(channel, remove_mean(record.channel(channel)));
  }
}

std::string sizes_of(const Recording& recording, const Clock& clock) {
  std::size_t n_samples = 0;
  for (const Record& piece : recording.pieces) n_samples += piece.n_samples();
  std::string text = std::to_string(n_samples) + " samples, " +
                     to_text(std::round(1e3 * double(n_samples) / clock.sampling_rate_hz) / 1e3) +
                     " s";
  if (recording.pieces.size() > 1)
    text += " in " + std::to_string(recording.pieces.size()) + " pieces";
  if (const std::size_t short_ones = clock.pieces.size() - recording.pieces.size(); short_ones > 0)
    text += ", without " + std::to_string(short_ones) + (short_ones == 1 ? " piece" : " pieces") +
            " of fewer than " + std::to_string(least_samples);
  return text;
}

// Stamps beside a given rate tell lost samples. Where they contradict it or cannot be read, the
// rate alone counts, and why is said.
std::optional<Clock> clock_beside_rate(const RecordTable& table, const std::string& name,
                                       Sources& sources, const ReadOptions& options,
                                       const std::size_t n_rows) {
  if (!sources.time_is_beside_rate || options.resample_hz) return std::nullopt;
  ReadOptions in_pieces = options;
  in_pieces.gaps = Gaps::pieces;
  std::optional<Clock> clock;
  std::string reason;
  try {
    clock = read_clock(table, name, sources, in_pieces, n_rows);
    if (std::ranges::none_of(clock->pieces, [](auto& p) { return p.count >= least_samples; }))
      throw UserError(clock->words + "; no piece has " + std::to_string(least_samples) +
                      " samples");
  } catch (const UserError& error) {
    reason = " as given; the stamps of '" + table.columns()[sources.time->column] +
             "' are not used (" + error.what() + ")";
    clock.reset();
    sources.time.reset();
  }
  // Names the first loss.
  const bool refuses = clock && options.gaps == Gaps::refuse && clock->pieces.size() > 1;
  if (!clock || refuses) clock = read_clock(table, name, sources, options, n_rows);
  clock->words += reason;
  return clock;
}

}  // namespace

std::string to_string(const FileReading& reading) {
  return reading.file + ": read as: " + reading.words;
}

std::size_t Recording::longest() const {
  const auto shorter = [](const Record& a, const Record& b) {
    return a.n_samples() < b.n_samples();
  };
  return std::size_t(std::max_element(pieces.begin(), pieces.end(), shorter) - pieces.begin());
}

Recording read_recording(const std::filesystem::path& file, const ReadOptions& options) {
  check(options);
  const auto table = formats::open_table(file, options.text);
  return read_recording(*table, file.string(), options);
}

Recording read_recording(formats::RecordTable& table, const std::string& name,
                         const ReadOptions& options) {
  check(options);
  if (!table.rate_groups().empty()) return read_several_rates(table, name, options);
  for (const ColumnChoice& choice : options.columns)
    for (const std::string& name : {choice.column, choice.column_with_unit, choice.text})
      table.take_rows_of(name);
  Sources sources = find_sources(table, options);
  const std::size_t n_rows = number_of_rows(table, options);
  std::optional<Clock> clock = clock_beside_rate(table, name, sources, options, n_rows);
  Recording recording;
  recording.pieces = read_rows(table, name, sources, options, n_rows, clock);
  for (Record& piece : recording.pieces) remove_means(options, piece);
  recording.epoch_s = clock->epoch_s;
  for (const Source& source : sources.channels)
    if (source.keeps_unit) recording.kept_unit = source.unit;
  const std::string layout = table.layout_text();
  recording.words = (layout.empty() ? "" : layout + "; ") + clock->words + "; " +
                    sizes_of(recording, *clock) + "; " + to_string(sources, table);
  return recording;
}

Record read_record(const std::filesystem::path& file, const ReadOptions& options) {
  Recording recording = read_recording(file, options);
  return std::move(recording.pieces[recording.longest()]);
}

void write_record(const std::filesystem::path& file, const Record& record) {
  const formats::FileFormat& format = formats::format_of(file);
  const std::string ending = formats::extension_of(file);
  const bool is_text = ending.empty() || ending == ".txt" || ending == ".dat";
  if (!format.has(ending) && !is_text)
    throw UserError(file.string() + ": '" + ending +
                    "' cannot be written as a record; use .csv, .mat, .h5, .npy or .uff");
  if (!format.write)
    throw UserError(file.string() +
                    ": a sound file cannot store the units and the start of a record; use .csv, "
                    ".mat, .h5, .npy or .uff");
  format.write(file, record);
}

}  // namespace vibrissa::signals
