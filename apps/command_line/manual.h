#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace vibrissa::apps {

/// The manual page (section 1) of all commands in troff, from the very descriptions that --help
/// prints. Proven by tests/apps/manual_test.cc.
std::string manual_page(CLI::App& app);

/// The same for programs: {"name", "description", "options": [{"name", "description", "value",
/// "default", "is_required"}], "footer", "commands": [...]}, commands within commands alike.
nlohmann::json manual_json(const CLI::App& app);

/// A script that completes the names of commands and options, and files. shell: bash or zsh.
std::string completion_script(CLI::App& app, const std::string& shell);

}  // namespace vibrissa::apps
