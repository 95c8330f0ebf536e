#include "apps/command_line/parse_advice.h"

#include <algorithm>
#include <vector>

#include "apps/command_line/command_names.h"
#include "signals/base/error.h"

namespace vibrissa::apps {
namespace {

CLI::App* find_command(CLI::App& app, const std::string& name) {
  for (CLI::App* const command : app.get_subcommands({}))
    if (command->get_name() == name) return command;
  return nullptr;
}

// The innermost command that the words name; at: the first word behind its name.
CLI::App* innermost(CLI::App& app, const int argc, const char* const* argv, int& at) {
  CLI::App* command = &app;
  for (at = 1; at < argc; ++at) {
    CLI::App* const next = find_command(*command, argv[at]);
    if (next == nullptr) break;
    command = next;
  }
  return command;
}

}  // namespace

std::string command_advice(CLI::App& app, const int argc, const char* const* argv) {
  int at = 1;
  CLI::App* const command = innermost(app, argc, argv, at);
  const bool expects_command = !command_names(*command).empty();
  if (at < argc && expects_command && argv[at][0] != '-')
    return signals::unknown_name("command", argv[at], command_names(*command));
  return {};
}

std::string parse_advice(CLI::App& app, const int argc, const char* const* argv) {
  int at = 1;
  CLI::App* const command = innermost(app, argc, argv, at);
  const std::vector<std::string> options = option_names(*command);
  for (; at < argc; ++at) {
    const std::string word = argv[at];
    const std::string name = word.substr(0, word.find('='));
    const bool is_option = name.starts_with("--") && name.size() > 2;
    if (is_option && std::find(options.begin(), options.end(), name) == options.end())
      return signals::unknown_name("option", name, options);
  }
  return {};
}

}  // namespace vibrissa::apps
