#include <iostream>
#include <memory>

#include "apps/command.h"
#include "apps/manual.h"

namespace vibrissa::apps {

void add_completion_command(CLI::App& app) {
  const auto shell = std::make_shared<std::string>("bash");
  auto* command =
      app.add_subcommand("completion", "Completion of commands and options for a shell");
  command->add_option("shell", *shell, "bash or zsh")
      ->check(CLI::IsMember({"bash", "zsh"}))
      ->capture_default_str();
  command->footer(
      "Examples:\n"
      "  vibrissa completion bash > /etc/bash_completion.d/vibrissa\n"
      "  source <(vibrissa completion zsh)");
  command->callback([&app, shell] { std::cout << completion_script(app, *shell); });
}

void add_manual_command(CLI::App& app) {
  auto* command = app.add_subcommand("manual", "The manual page of all commands, for man");
  command->footer("Example:\n  vibrissa manual | man -l -");
  command->callback([&app] { std::cout << manual_page(app); });
}

}  // namespace vibrissa::apps
