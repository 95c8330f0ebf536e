#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/command_line/command.h"
#include "signals/files/record_io.h"
#include "signals/files/response_file.h"
#include "signals/record/record.h"

namespace vibrissa::apps {

/// How a command takes a record file: --column, --rate, --rows, --remove-mean, --gaps, and the
/// layout of a text table.
struct RecordOptions {
  std::vector<std::string> columns;
  std::optional<double> rate_hz;
  std::optional<std::string> rows;
  std::vector<std::string> remove_mean;
  std::string gaps = "pieces";
  std::optional<std::string> separator, decimal;
  std::optional<std::size_t> header_lines;
  std::optional<double> resample_hz;
  std::optional<std::string> join, align;

  void add_to(CLI::App& command);
  /// The longest piece. Says on standard error how the file was read, which piece this is, and
  /// which magnitudes look like another unit's. Throws UserError as read_recording does, and for
  /// rows that are not FIRST:LAST.
  signals::Record read(const std::string& file) const;
  /// The same, but a base_moment whose unit is that of no moment, as a Hall sensor's uT without its
  /// calibration, stays in it. Sets the unit of base_moment. Proven by
  /// tests/apps/identify_command_test.cc.
  signals::Record read_in_own_unit(const std::string& file, std::string& unit) const;
  /// All pieces; says the same, but for the piece.
  signals::Recording read_pieces(const std::string& file) const;
  /// Takes the longest piece out of the recording; says which it is.
  static signals::Record take_longest(const std::string& file, signals::Recording& recording);
  /// What read_record is told. Throws UserError as read does, and for --join, which needs read().
  signals::ReadOptions read_options() const;
  /// Throws UserError for options of a text table where the file is none.
  void refuse_unused(const std::string& file) const;
  /// One further column of the same rows, in its own unit.
  std::vector<double> read_column(const std::string& file, const std::string& column) const;

 private:
  bool is_quiet() const;
  signals::ReadOptions options_of_each() const;
  signals::Recording read_said(const std::string& file, const signals::ReadOptions& options) const;
  signals::Recording read_joined(const std::string& file) const;
  signals::Recording join_clocks(const signals::Recording& one,
                                 const signals::Recording& other) const;

  const CLI::App* command_ = nullptr;
};

/// "FILE: read as: WORDS" on standard error.
void say_how_read(const std::string& file, const std::string& words);

/// A frequency response; says on standard error how its unit was found, also where quiet when its
/// values are no moment per acceleration.
signals::formats::FileResponse read_said_response(const std::string& file, const std::string& as,
                                                  const CommonOptions& common);

/// {"record", "samples", "sampling_rate_hz", "channels"}: what a command says of a record it wrote.
nlohmann::json written_record_json(const std::string& file, const signals::Record& record);
/// The same as a line.
std::string written_record_text(const std::string& file, const signals::Record& record);

/// Throws UserError where an output is one of the files that are read, or is named twice: a
/// recording is not replaced by what was made of it. Absent ones are none.
using FileNames = std::vector<std::optional<std::string>>;
void refuse_overwriting(const FileNames& inputs, const FileNames& outputs);

}  // namespace vibrissa::apps
