#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/command_line/command.h"
#include "apps/command_line/manual.h"

namespace vibrissa::apps {

void add_completion_command(CLI::App& app) {
  const auto shell = std::make_shared<std::string>("bash");
  const auto common = std::make_shared<CommonOptions>();
  auto* command =
      app.add_subcommand("completion", "Prints the completion of commands and options for a shell");
  command->add_option("shell", *shell, "bash or zsh")
      ->check(CLI::IsMember({"bash", "zsh"}))
      ->capture_default_str();
  add_common_options(*command, *common);
  command->footer(
      "Examples:\n"
      "  vibrissa completion bash > /etc/bash_completion.d/vibrissa\n"
      "  source <(vibrissa completion zsh)");
  command->callback([&app, shell, common] {
    const std::string script = completion_script(app, *shell);
    if (common->json)
      print_json({{"shell", *shell}, {"script", script}});
    else
      std::cout << script;
  });
}

void add_manual_command(CLI::App& app) {
  const auto common = std::make_shared<CommonOptions>();
  auto* command = app.add_subcommand("manual", "Prints the manual page of all commands, for man");
  add_common_options(*command, *common);
  command->footer(
      "Examples:\n"
      "  vibrissa manual | man -l -\n"
      "  vibrissa manual --json | jq '.commands[].name'");
  command->callback([&app, common] {
    if (common->json)
      print_json(manual_json(app));
    else
      std::cout << manual_page(app);
  });
}

}  // namespace vibrissa::apps
