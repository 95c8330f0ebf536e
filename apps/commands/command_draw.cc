#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/command_line/command.h"
#include "apps/command_line/programs.h"
#include "signals/base/error.h"

namespace vibrissa::apps {

namespace {

nlohmann::json to_json(const report::PictureReport& pictures) {
  nlohmann::json made = nlohmann::json::array();
  for (const auto& picture : pictures.made) made.push_back(picture.string());
  return {{"made", made}, {"problems", pictures.problems}, {"message", pictures.message}};
}

void draw(const std::string& folder, const CommonOptions& common) {
  if (!std::filesystem::is_directory(folder))
    throw signals::UserError(folder + ": this folder holds no results");
  const report::PictureReport pictures = draw_pictures(folder);
  if (common.json) print_json(to_json(pictures));
  if (common.is_talkative()) std::cout << pictures.message << std::endl;
  if (pictures.made.empty() || !pictures.problems.empty())
    throw signals::UserError(folder + ": some plots could not be drawn");
}

}  // namespace

void add_draw_command(CLI::App& app) {
  const auto folder = std::make_shared<std::string>();
  const auto common = std::make_shared<CommonOptions>();
  auto* command = app.add_subcommand(
      "draw",
      "Draws the plots of a results folder again (shapes in 3-D need a display, or xvfb-run)");
  command->add_option("folder", *folder, "Results folder")->required();
  add_common_options(*command, *common);
  command->footer(
      "Example:\n"
      "  vibrissa draw results/flow_sensor");
  command->callback([folder, common] { draw(*folder, *common); });
}

}  // namespace vibrissa::apps
