#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace vibrissa::apps {

/// What a user who misspelt a command or an option probably meant, as a line; empty when nothing is
/// misspelt. Proven by tests/apps/manual_test.cc.
std::string parse_advice(CLI::App& app, int argc, const char* const* argv);

}  // namespace vibrissa::apps
