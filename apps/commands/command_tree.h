#pragma once

#include <CLI/CLI.hpp>
#include <memory>

namespace vibrissa::apps {

/// All that may be said on the command line; parsing it does the work. Proven by
/// tests/apps/manual_test.cc, and by tests/fuzz/fuzz_command_line.cc for words of any kind.
std::unique_ptr<CLI::App> command_tree();

}  // namespace vibrissa::apps
