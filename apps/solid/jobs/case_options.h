#pragma once

#include <CLI/CLI.hpp>

#include "case/case_overrides.h"

namespace vibrissa::apps {

/// Command-line options that override entries of a case file.
struct CaseOptions : sensor_case::CaseOverrides {
  /// The case file and --set: for commands that ask for the sensor alone. Settings that change
  /// nothing for this use are refused.
  void add_case_to(CLI::App& command, sensor_case::CaseUse use);
  void add_settings_to(CLI::App& command, sensor_case::CaseUse use);
  /// These, and the inputs.
  void add_to(CLI::App& command, sensor_case::CaseUse use);
  /// For commands that leave a results folder.
  void add_folder_to(CLI::App& command);
};

}  // namespace vibrissa::apps
