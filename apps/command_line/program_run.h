#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace vibrissa::apps {

using AddCommand = void (*)(CLI::App&);

/// All that may be said to a program with these commands; parsing it does the work.
std::unique_ptr<CLI::App> tree_of(std::span<const AddCommand> commands);

/// Exit status of a program, and what it tells on standard error; empty when all is well, or has
/// been said.
struct Outcome {
  int status = 0;
  std::string message{};
};

/// Parses the words and does the work; exceptions become an outcome. before: checks that may throw;
/// is_out_of_memory: beside std::bad_alloc. What was printed must have arrived: a full disk behind
/// a redirection is a failure, unless is_muted.
Outcome run_program(std::span<const AddCommand> commands, int argc, char** argv,
                    const std::function<void()>& before,
                    const std::function<bool(const std::exception&)>& is_out_of_memory,
                    bool is_muted);

/// What a program prepares first: freed memory is kept for reuse, and a file that grows beyond a
/// limit is an error like a full disk, not the end without a word.
void prepare_program();

}  // namespace vibrissa::apps
