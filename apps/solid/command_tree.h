#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <span>

#include "apps/command_line/program_run.h"

namespace vibrissa::apps {

/// Every command of the program, in the order of --help.
std::span<const AddCommand> all_commands();

/// All that may be said on the command line; parsing it does the work. Proven by
/// tests/apps/manual_test.cc, and by tests/fuzz/fuzz_command_line.cc for words of any kind.
std::unique_ptr<CLI::App> command_tree();

}  // namespace vibrissa::apps
