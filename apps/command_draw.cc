#include <memory>

#include "apps/command.h"
#include "report/pictures.h"
#include "signals/error.h"

namespace vibrissa::apps {

void add_draw_command(CLI::App& app) {
  const auto folder = std::make_shared<std::string>();
  auto* command = app.add_subcommand(
      "draw", "Draws the figures of a results folder again (needs a display, or xvfb-run)");
  command->add_option("folder", *folder, "Results folder")->required();
  command->footer(
      "Example:\n"
      "  vibrissa draw runs/flow_sensor");
  command->callback([folder] {
    if (report::draw_folder(*folder) != 0) {
      throw signals::UserError(*folder + ": not every figure could be drawn");
    }
  });
}

}  // namespace vibrissa::apps
