#pragma once

#include <optional>
#include <string>
#include <vector>

#include "case/case_file.h"
#include "case/unused_entries.h"

namespace vibrissa::sensor_case {

/// A case file and replacements of its entries: recorded inputs, and any entry by name. The texts
/// are those of the command-line options with the same names.
struct CaseOverrides {
  std::string case_file;
  std::optional<std::string> base_acceleration_file, wind_file, output_folder;
  std::vector<std::string> columns, rates, rows, ranges, remove_means, settings;
  std::optional<std::string> duration_s;
  /// What the case is for; settings that change nothing for it are refused.
  std::optional<CaseUse> use;

  /// Whether nothing replaces an entry.
  bool is_plain() const;
  /// The case file with the replaced entries. Throws UserError with the option, also when it refers
  /// to a recording that the run does not read. A setting that changes geometry or material takes
  /// the case's calibration note away. Proven by tests/apps/real_input_test.cc and
  /// tests/apps/unused_options_test.cc.
  CaseFile load() const;
};

}  // namespace vibrissa::sensor_case
