#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace vibrissa::apps {

/// Names of a command's own commands.
std::vector<std::string> command_names(CLI::App& command);

/// Long names of a command's options, as they are typed: "--json".
std::vector<std::string> option_names(const CLI::App& command);

}  // namespace vibrissa::apps
