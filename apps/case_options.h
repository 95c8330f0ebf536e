#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/case_file.h"

namespace vibrissa::apps {

/// Command-line options that override entries of a case file: recorded inputs and any entry by
/// name.
struct CaseOptions {
  std::string case_file;
  std::optional<std::string> base_acceleration_file, wind_file, output_folder;
  std::vector<std::string> columns, rates, rows, ranges, remove_means, settings;
  std::optional<std::string> duration_s;

  /// The case file and --set: for commands that ask for the sensor alone.
  void add_case_to(CLI::App& command);
  void add_settings_to(CLI::App& command);
  /// These, and the inputs.
  void add_to(CLI::App& command);
  /// For commands that leave a results folder.
  void add_folder_to(CLI::App& command);
  /// Whether nothing overrides the case file.
  bool is_plain() const;
  /// The case file with the overrides set. Throws UserError naming the option, also where it is
  /// about a recording that the run does not read.
  CaseFile load() const;
};

}  // namespace vibrissa::apps
