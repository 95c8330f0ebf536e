#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace vibrissa::apps {

/// Throws UserError where one of these options was given on the command line and would change
/// nothing: "--low REASON; leave it out". Names that the command does not have are skipped. Proven
/// by tests/apps/unused_options_test.cc.
void refuse_given(const CLI::App& command, const std::vector<std::string>& options,
                  const std::string& reason);

/// All options of RecordOptions: for inputs that are no record.
const std::vector<std::string>& record_option_names();

}  // namespace vibrissa::apps
