#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "checks/record_report.h"

namespace vibrissa::checks {

enum class Serves { good, limited, no };
std::string to_string(Serves serves);

/// What records give to one command.
struct CommandVerdict {
  std::string command{};
  Serves serves = Serves::good;
  /// limited: what will be missing or doubtful; no: what to record instead. One sentence each.
  std::vector<std::string> reasons{};
};

using ServesTable = std::array<CommandVerdict, 4>;  // identify, separate, diagnose, plan

/// Which commands a record serves. Proven by tests/checks/check_record_test.cc.
ServesTable what_it_serves(const RecordReport& report);

/// The same for the records of one sensor: `identify` and `separate` take one record, so the best
/// one counts; `diagnose` and `plan` take all, and of_dataset are the findings about the whole.
ServesTable what_they_serve(std::span<const RecordReport> reports,
                            const std::vector<Finding>& of_dataset);

/// Whether the records stop only because none of their columns is named as a channel, so that
/// nothing needs to be recorded. Proven by tests/checks/check_file_test.cc.
bool only_names_are_missing(std::span<const RecordReport> reports);

/// Can every command work?
bool serves_all(const ServesTable& table);

}  // namespace vibrissa::checks
