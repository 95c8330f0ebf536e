#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/command_line/command.h"
#include "apps/command_line/programs.h"
#include "apps/solid/jobs/steady_curves.h"
#include "case/case_file.h"
#include "case/rig.h"
#include "fem/linalg/solver_session.h"
#include "report/files/run_folder.h"
#include "reproduction/paper_rig.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/system/progress.h"

namespace vibrissa::apps {

namespace {

struct Levels {
  double from, to;
  unsigned int points;
};

struct StaticCommandOptions {
  CommonOptions common;
  std::vector<std::string> case_files;
  Levels wind_m_s{0.1, 4., 17}, base_g{0.01, 1.3, 9};
  std::optional<std::string> folder;
};

std::vector<double> logarithmic(const Levels& levels, const std::string& name, const double unit) {
  const bool ascends = levels.from > 0. && levels.to > levels.from && std::isfinite(levels.to);
  if (!ascends)
    throw signals::UserError("--" + name + "-from " + signals::to_text(levels.from) + " and --" +
                             name + "-to " + signals::to_text(levels.to) +
                             " must be finite numbers, the first above zero and below the second");
  std::vector<double> values;
  for (unsigned int i = 0; i < levels.points; ++i)
    values.push_back(unit * levels.from *
                     std::pow(levels.to / levels.from,
                              static_cast<double>(i) / static_cast<double>(levels.points - 1)));
  return values;
}

/// File names without folder and extension, words apart; numbered where they repeat.
std::vector<std::string> names_of(const std::vector<std::string>& files) {
  std::vector<std::string> names;
  for (const auto& file : files) {
    std::string name = std::filesystem::path(file).stem().string();
    std::ranges::replace(name, '_', ' ');
    const auto taken = std::ranges::count(names, name);
    names.push_back(taken == 0 ? name : name + " " + std::to_string(taken + 1));
  }
  return names;
}

std::vector<SteadyCurves> make_curves(const StaticCommandOptions& options) {
  std::vector<double> wind = logarithmic(options.wind_m_s, "wind", 1.);
  wind.insert(wind.begin(), 0.);
  const auto base = logarithmic(options.base_g, "acceleration", reproduction::paper::g_m_s2);
  const auto names = names_of(options.case_files);
  std::vector<fem::SensorParameters> sensors;
  for (const auto& file : options.case_files) {
    const sensor_case::Case parameters = sensor_case::CaseFile(file).read();
    sensor_case::refuse_gravity(parameters, "the steady curve");
    sensors.push_back(parameters.sensor);
  }
  const fem::SolverSession session;
  signals::Progress progress("equilibria", sensors.size() * (wind.size() + base.size()),
                             options.common.is_talkative());
  std::vector<SteadyCurves> curves;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    curves.push_back(
        make_steady_curves(names[i], sensors[i], wind, base, [&progress] { progress.advance(); }));
  }
  return curves;
}

void write_results(const report::RunFolder& folder, const std::vector<SteadyCurves>& curves,
                   const nlohmann::json& document) {
  folder.write_run({given_command_line(), {}, {}});
  folder.write_text("steady_wind.csv", wind_table(curves).to_csv());
  folder.write_text("steady_acceleration.csv", acceleration_table(curves).to_csv());
  folder.write_text("exponents.csv", exponent_table(curves).to_csv());
  report::write_figure(folder.path(), steady_figure(curves));
  folder.write_json("summary.json", document);
}

void find_equilibria(const StaticCommandOptions& options) {
  report::RunFolder::refuse_taken(options.folder);
  const auto curves = make_curves(options);
  const auto folder = report::RunFolder::given_or_free(options.folder, "results/static");
  nlohmann::json document = steady_json(curves);
  document["folder"] = folder.path().string();
  write_results(folder, curves, document);
  const auto pictures = draw_pictures(folder.path());
  if (options.common.json) {
    print_json(document);
    return;
  }
  std::cout << "Exponent of the steady base moment against the load (straight lines through the "
               "logarithms):\n"
            << exponent_table(curves).to_text() << "\n"
            << pictures.message << "\nResults: " << folder.path().string() << "\n";
}

void add_levels(CLI::App& command, const std::string& name, const std::string& what,
                const std::string& unit, Levels& levels) {
  command
      .add_option("--" + name + "-from", levels.from,
                  "Lowest " + what + ", must be above 0 " + unit)
      ->capture_default_str();
  command.add_option("--" + name + "-to", levels.to, "Highest " + what + " " + unit)
      ->capture_default_str();
  command
      .add_option("--" + name + "-points", levels.points,
                  "Number of points, evenly spaced in the logarithm")
      ->check(CLI::Range(3, 500))
      ->capture_default_str();
}

}  // namespace

void add_static_command(CLI::App& app) {
  const auto options = std::make_shared<StaticCommandOptions>();
  auto* command = app.add_subcommand("static",
                                     "Computes the steady base moment as a function of wind speed "
                                     "and of base acceleration by the whole "
                                     "solid at finite strain (figure 8 of the reference paper)");
  command->add_option("cases", options->case_files, "Case files (.prm), one for each sensor")
      ->required();
  add_levels(*command, "wind", "wind speed", "[m/s]", options->wind_m_s);
  add_levels(*command, "acceleration", "base acceleration", "[g]", options->base_g);
  command->add_option("-o,--output,--out", options->folder,
                      "Results folder; must be new or empty (default: results/static)");
  add_common_options(*command, options->common);
  command->footer(
      "Example:\n"
      "  vibrissa static cases/flow_sensor.prm cases/whisker_sensor.prm --wind-to 6 -o steady");
  command->callback([options] { find_equilibria(*options); });
}

}  // namespace vibrissa::apps
