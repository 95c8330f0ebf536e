#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace vibrissa::apps {

/// The command that a user who misspelt one probably meant, as a line; empty when the first words
/// are known commands. Proven by tests/apps/exit_status_test.cc.
std::string command_advice(CLI::App& app, int argc, const char* const* argv);

/// The option that a user who misspelt one probably meant, as a line; empty when none is misspelt.
/// Proven by tests/apps/manual_test.cc.
std::string parse_advice(CLI::App& app, int argc, const char* const* argv);

}  // namespace vibrissa::apps
