#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "signals/files/record_io.h"
#include "signals/record/record.h"

namespace vibrissa::apps {

/// How a command takes a record file: --column, --rate, --rows, --remove-mean.
struct RecordOptions {
  std::vector<std::string> columns;
  std::optional<double> rate_hz;
  std::optional<std::string> rows;
  std::vector<std::string> remove_mean;

  void add_to(CLI::App& command);
  /// Throws UserError as read_record does, and for rows that are not FIRST:LAST.
  /// Warns on standard error of magnitudes that look like another unit's.
  signals::Record read(const std::string& file) const;
  /// What read_record is told. Throws UserError as read does.
  signals::ReadOptions read_options() const;
  /// One further column of the same rows, in its own unit.
  std::vector<double> read_column(const std::string& file, const std::string& column) const;
};

/// {"record", "samples", "sampling_rate_hz", "channels"}: what a command says of a record it wrote.
nlohmann::json written_record_json(const std::string& file, const signals::Record& record);
/// The same as a line.
std::string written_record_text(const std::string& file, const signals::Record& record);

/// Throws UserError where an output is one of the files that are read, or is named twice: a
/// recording is not replaced by what was made of it. Absent ones are none.
using FileNames = std::vector<std::optional<std::string>>;
void refuse_overwriting(const FileNames& inputs, const FileNames& outputs);

}  // namespace vibrissa::apps
