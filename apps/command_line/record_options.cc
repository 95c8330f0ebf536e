#include "apps/command_line/record_options.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "separation/clocks/joined_by_response.h"
#include "signals/base/error.h"
#include "signals/base/trimmed.h"
#include "signals/base/unit.h"
#include "signals/files/file_format.h"
#include "signals/files/joined_recording.h"
#include "signals/files/row_range.h"
#include "signals/record/channel_name.h"
#include "signals/record/column_unit.h"
#include "signals/record/plausibility.h"

namespace vibrissa::apps {

void refuse_overwriting(const FileNames& inputs, const FileNames& outputs) {
  std::error_code missing;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (!outputs[i]) continue;
    for (const auto& input : inputs)
      if (input && std::filesystem::equivalent(*input, *outputs[i], missing))
        throw signals::UserError(
            *outputs[i] +
            ": this file is an input and is not overwritten; name another file to write");
    for (std::size_t j = 0; j < i; ++j)
      if (outputs[j] && std::filesystem::weakly_canonical(*outputs[j], missing) ==
                            std::filesystem::weakly_canonical(*outputs[i], missing))
        throw signals::UserError(*outputs[i] +
                                 ": this file would be written twice; name two different files");
  }
}

nlohmann::json written_record_json(const std::string& file, const signals::Record& record) {
  return {{"record", file},
          {"samples", record.n_samples()},
          {"sampling_rate_hz", record.sampling_rate_hz()},
          {"channels", record.channel_names()}};
}

std::string written_record_text(const std::string& file, const signals::Record& record) {
  std::ostringstream text;
  text << "wrote " << file << ": " << record.n_samples() << " samples at "
       << record.sampling_rate_hz() << " Hz\n";
  return text.str();
}

namespace {

void add_layout_options(CLI::App& command, RecordOptions& options) {
  command
      .add_option(
          "--gaps", options.gaps,
          "Where samples are lost: pieces, the longest piece between losses is used; refuse")
      ->check(CLI::IsMember({"pieces", "refuse"}))
      ->capture_default_str();
  command
      .add_option("--separator", options.separator,
                  "What separates the columns of a text table (default: recognised)")
      ->check(CLI::IsMember({"comma", "semicolon", "tab", "blank", "none"}));
  command
      .add_option("--decimal", options.decimal,
                  "Decimal mark of a text table (default: recognised)")
      ->check(CLI::IsMember({"point", "comma"}));
  command.add_option(
      "--join", options.join,
      "Further file of another device; its channels are joined at the sampling times "
      "of the slower device");
  command
      .add_option(
          "--align", options.align,
          "How --join puts both on one clock: stamps, as both have them; motion, offset and "
          "drift from a channel in both, or from acceleration and moment (default: motion "
          "where a channel is in both or only one file has dates)")
      ->check(CLI::IsMember({"stamps", "motion"}));
  command.add_option("--resample", options.resample_hz,
                     "For uneven sampling: even rate [Hz] at which a band-limited signal is "
                     "estimated; its error is said");
  command.add_option("--header-lines", options.header_lines,
                     "Number of lines before the first row of a text table (default: recognised)");
}

signals::formats::TextOptions text_options(const RecordOptions& options) {
  static const std::map<std::string, char> separators{
      {"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"blank", ' '}, {"none", '\0'}};
  signals::formats::TextOptions text;
  if (options.separator) text.separator = separators.at(*options.separator);
  if (options.decimal) text.decimal = *options.decimal == "comma" ? ',' : '.';
  text.header_lines = options.header_lines;
  return text;
}

}  // namespace

void say_how_read(const std::string& file, const std::string& words) {
  std::cerr << to_string(signals::FileReading{file, words}) << std::endl;
}

signals::formats::FileResponse read_said_response(const std::string& file, const std::string& as,
                                                  const CommonOptions& common) {
  auto response = signals::formats::read_response(file, {.as = as, .may_keep_unit = true});
  const bool is_moment = response.unit == signals::formats::moment_per_acceleration;
  if (!common.quiet || !is_moment) say_how_read(file, response.words);
  return response;
}

bool RecordOptions::is_quiet() const {
  const CLI::Option* const quiet =
      command_ == nullptr ? nullptr : command_->get_option_no_throw("--quiet");
  return quiet != nullptr && quiet->count() > 0;
}

void RecordOptions::add_to(CLI::App& command) {
  command_ = &command;
  command.add_option(
      "--column", columns,
      "Says which column of the file is which channel: CHANNEL=COLUMN. Channels: time, "
      "base_acceleration, base_moment, wind_speed and others (docs/records.md). The unit of the "
      "column stands in square brackets, a factor behind it: 'base_acceleration=ax[g]', "
      "'time=t[ms]', "
      "'base_moment=B[uT]*0.18[N m/T]'. Without units the values are in SI. Other channels are "
      "columns that have the channel's name; repeatable");
  command.add_option("--rate", rate_hz, "Sampling rate [Hz], for a file without time");
  command.add_option("--rows", rows,
                     "FIRST:LAST: rows that are used; row 1 is the first behind the column names");
  command.add_option("--remove-mean", remove_mean,
                     "Channel whose mean is subtracted, e.g. base_acceleration; repeatable");
  add_layout_options(command, *this);
}

signals::ReadOptions RecordOptions::read_options() const {
  if (join)
    throw signals::UserError(
        "--join: this command reads records one by one; join the files first by 'vibrissa "
        "convert'");
  return options_of_each();
}

signals::ReadOptions RecordOptions::options_of_each() const {
  if (align && !join) throw signals::UserError("--align needs --join; leave it out");
  signals::ReadOptions options;
  options.sampling_rate_hz = rate_hz;
  options.remove_mean = remove_mean;
  options.text = text_options(*this);
  options.resample_hz = resample_hz;
  options.gaps = gaps == "pieces" ? signals::Gaps::pieces : signals::Gaps::refuse;
  if (rows) {
    const signals::RowRange range = signals::parse_rows(*rows, "--rows");
    options.first_row = range.first;
    options.n_rows = range.count;
  }
  for (const auto& text : columns) options.columns.push_back(signals::parse_column_choice(text));
  return options;
}

namespace {

/// Where each clock begins at zero, equal stamps prove nothing: the motion is asked.
void warn_of_other_offset(const signals::Recording& one, const signals::Recording& other) {
  if (one.epoch_s != 0. || !separation::has_response_between(one, other)) return;
  try {
    const signals::ClockRelation clocks = separation::clocks_by_response(one, other).clocks;
    constexpr double significant = 4., of_a_hold = 1.5;  // deviations, samples
    const double sample_s = 1. / one.pieces.front().sampling_rate_hz();
    if (std::abs(clocks.offset_s) > significant * clocks.offset_deviation_s + of_a_hold * sample_s)
      std::cerr << "warning: --join: by the motion, " << signals::clock_words(clocks)
                << "; --align motion uses this, --align stamps is what was done" << std::endl;
  } catch (const signals::UserError&) {
    // The motion does not tell.
  }
}

signals::Recording joined_by_motion(const signals::Recording& one, const signals::Recording& other,
                                    const std::optional<std::string>& shared) {
  if (!shared && separation::has_response_between(one, other))
    return separation::joined_by_response(one, other);
  if (!shared)
    throw signals::UserError(
        "--align motion: the files share no channel; name one that both measured, such as "
        "base_acceleration, or base_acceleration of one and base_moment of the other (--column)");
  signals::Recording both = signals::joined(
      one, other,
      signals::clocks_of(one, *shared, other, *shared, signals::SharedMotion::quantity));
  both.words += "; by " + *shared + " in both";
  return both;
}

}  // namespace

signals::Recording RecordOptions::join_clocks(const signals::Recording& one,
                                              const signals::Recording& other) const {
  const auto shared = signals::shared_channel(one, other);
  const bool has_one_dates = (one.epoch_s == 0.) != (other.epoch_s == 0.);
  if (align ? *align == "motion" : shared || has_one_dates)
    return joined_by_motion(one, other, shared);
  if (!align) warn_of_other_offset(one, other);
  return signals::joined(one, other);
}

// Each file gives the chosen columns that it has; every choice must be in one of them.
signals::Recording RecordOptions::read_joined(const std::string& file) const {
  signals::ReadOptions options = options_of_each();
  options.skips_missing_columns = true;
  const signals::Recording one = signals::read_recording(file, options);
  const signals::Recording other = signals::read_recording(*join, options);
  for (const signals::ColumnChoice& choice : options.columns)
    if (choice.channel != signals::time_channel && !one.pieces.front().has(choice.channel) &&
        !other.pieces.front().has(choice.channel))
      throw signals::UserError("column '" + choice.column + "' is neither in " + file + " nor in " +
                               *join);
  if (!is_quiet()) {
    say_how_read(file, one.words);
    say_how_read(*join, other.words);
  }
  return join_clocks(one, other);
}

namespace {

/// Whether this is a text table, or a folder that has one.
bool is_text(const std::filesystem::path& file) {
  namespace formats = signals::formats;
  if (std::error_code none; std::filesystem::is_directory(file, none)) {
    const std::filesystem::directory_iterator entries(file);
    return std::any_of(begin(entries), end(entries), [](const auto& entry) {
      const auto ending = entry.path().extension();
      return ending != ".json" && !entry.is_directory() && is_text(entry.path());
    });
  }
  return &formats::format_of(file) == &formats::file_formats().front();
}

}  // namespace

void RecordOptions::refuse_unused(const std::string& file) const {
  if (is_text(file) || (join && is_text(*join))) return;
  for (const auto& [name, is_given] : {std::pair{"--separator", separator.has_value()},
                                       {"--decimal", decimal.has_value()},
                                       {"--header-lines", header_lines.has_value()}})
    if (is_given)
      throw signals::UserError(std::string(name) + " is for text tables, and " + file +
                               " is none; leave it out");
}

signals::Recording RecordOptions::read_said(const std::string& file,
                                            const signals::ReadOptions& options) const {
  refuse_unused(file);
  signals::Recording recording = join ? read_joined(file) : signals::read_recording(file, options);
  if (!is_quiet()) say_how_read(file, recording.words);
  return recording;
}

namespace {

void warn_of_magnitudes(const std::string& file, const signals::Recording& recording) {
  for (const std::string& remark :
       signals::implausible_magnitudes(recording.pieces[recording.longest()]))
    std::cerr << "warning: " << file << ": " << remark << std::endl;
}

}  // namespace

signals::Recording RecordOptions::read_pieces(const std::string& file) const {
  signals::Recording recording = read_said(file, options_of_each());
  warn_of_magnitudes(file, recording);
  return recording;
}

signals::Record RecordOptions::read(const std::string& file) const {
  signals::Recording recording = read_pieces(file);
  return take_longest(file, recording);
}

signals::Record RecordOptions::read_in_own_unit(const std::string& file, std::string& unit) const {
  unit = signals::unit_of_channel(signals::channel::base_moment);
  if (join) return read(file);
  signals::ReadOptions options = options_of_each();
  options.keeps_unit_of = signals::channel::base_moment;
  signals::Recording recording = read_said(file, options);
  if (recording.kept_unit.empty()) {
    warn_of_magnitudes(file, recording);
    return take_longest(file, recording);
  }
  unit = recording.kept_unit;
  std::cerr << file << ": base_moment stays in " << unit
            << ", for it has no calibration: amplitudes are in " << unit
            << "; frequencies and damping ratios need none" << std::endl;
  return take_longest(file, recording);
}

signals::Record RecordOptions::take_longest(const std::string& file,
                                            signals::Recording& recording) {
  const std::size_t longest = recording.longest();
  signals::Record record = std::move(recording.pieces[longest]);
  if (recording.pieces.size() > 1)
    std::cerr << "warning: " << file << ": the longest of " << recording.pieces.size()
              << " pieces is used, piece " << longest + 1 << ": " << record.n_samples()
              << " samples from " << record.time_s(0) << " s on; 'vibrissa convert' writes all"
              << std::endl;
  recording.pieces.erase(recording.pieces.begin() + std::ptrdiff_t(longest));
  return record;
}

std::vector<double> RecordOptions::read_column(const std::string& file,
                                               const std::string& column) const {
  signals::ReadOptions options = options_of_each();
  options.columns = {{.channel = column, .column = column}};
  options.remove_mean.clear();
  const signals::Record record = signals::read_record(file, options);
  const auto values = record.channel(column);
  return {values.begin(), values.end()};
}

}  // namespace vibrissa::apps
