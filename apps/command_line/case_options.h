#pragma once

#include <CLI/CLI.hpp>

#include "case/case_overrides.h"

namespace vibrissa::apps {

/// Command-line options that override entries of a case file.
struct CaseOptions : sensor_case::CaseOverrides {
  /// The case file and --set: for commands that ask for the sensor alone.
  void add_case_to(CLI::App& command);
  void add_settings_to(CLI::App& command);
  /// These, and the inputs.
  void add_to(CLI::App& command);
  /// For commands that leave a results folder.
  void add_folder_to(CLI::App& command);
};

}  // namespace vibrissa::apps
