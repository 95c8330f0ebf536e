#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/command.h"
#include "apps/paper_figures.h"
#include "apps/paper_numbers.h"
#include "apps/paper_rig.h"
#include "apps/reproduction_page.h"
#include "report/pictures.h"
#include "report/run_folder.h"

namespace vibrissa::apps {

namespace {

struct ReproduceOptions {
  CommonOptions common;
  std::string flow_case = "cases/flow_sensor.prm", whisker_case = "cases/whisker_sensor.prm";
  std::optional<std::string> folder;
};

Reproduction reproduce_paper(const ReproduceOptions& options, const bool show_progress) {
  auto sensors = make_paper_sensors(options.flow_case, options.whisker_case, show_progress);
  auto simulation = simulate_paper_simulation(sensors);
  auto experiment = simulate_paper_experiment(sensors);
  auto readings = compare_fdaf_readings(sensors, experiment);
  using separation::IdentifyMethod;
  const auto whisker = paper_simulation_records(sensors.whisker).vibration_only;
  const double flow_srivc =
      held_out_fit_percent(simulation.records.vibration_only, IdentifyMethod::srivc);
  return {.sensors = std::move(sensors),
          .simulation = std::move(simulation),
          .experiment = std::move(experiment),
          .flow_srivc_fit_percent = flow_srivc,
          .whisker_fit_percent = held_out_fit_percent(whisker, IdentifyMethod::output_error),
          .whisker_srivc_fit_percent = held_out_fit_percent(whisker, IdentifyMethod::srivc),
          .readings = std::move(readings)};
}

std::vector<report::Figure> figures_of(const Reproduction& result) {
  return {step_responses(result.sensors.wire),
          steady_responses(result.sensors),
          base_responses(result.sensors),
          estimates(result.simulation, "figure_10_simulation",
                    "Simulation: wind and vibration, true and separated"),
          estimates(result.experiment, "figure_11_experiment",
                    "Simulated experiment: wind and vibration, true and separated"),
          experiment_spectra(result.experiment)};
}

std::string report_text(const Reproduction& result) {
  return "The paper's numbers\n\n" + numbers_table(paper_numbers(result)).to_markdown() +
         "\nThe \"experiment\" is simulated with the built sensor's published figures and "
         "noise.\n" +
         "\nSettings of the adaptive filter, tried on the simulated experiment\n\n" +
         readings_table(result.readings).to_markdown() + "\n" + explain(result.readings) + "\n" +
         "\nSimulation\n\n" + separation_table(result.simulation.separated).to_markdown() +
         "\nSimulated experiment\n\n" +
         separation_table(result.experiment.separated).to_markdown() + "\n" +
         metric_notes(paper::settling_s) + "\n";
}

void reproduce(const ReproduceOptions& options) {
  report::RunFolder::refuse_taken(options.folder);
  const bool quiet = options.common.quiet || options.common.json;
  const Reproduction result = reproduce_paper(options, !quiet);
  const auto folder = report::RunFolder::given_or_free(options.folder, "runs/reproduce");
  folder.write_run({given_command_line(), {}, {}});
  const std::string text = report_text(result);
  folder.write_text("reproduction.md", text);
  folder.write_text("numbers.csv", numbers_table(paper_numbers(result)).to_csv());
  folder.write_text("fdaf_readings.csv", readings_table(result.readings).to_csv());
  const std::vector<report::Figure> figures = figures_of(result);
  for (const report::Figure& figure : figures) report::write_figure(folder.path(), figure);
  nlohmann::json document = reproduction_json(result);
  document["folder"] = folder.path().string();
  folder.write_json("summary.json", document);
  const auto pictures = report::draw_pictures(folder.path());
  report::write_page(folder.path(), reproduction_page(result, figures));
  if (options.common.json) {
    print_json(document);
    return;
  }
  std::cout << text << "\n" << pictures.message << "\nResults: " << folder.path().string() << "\n";
}

}  // namespace

void add_reproduce_command(CLI::App& app) {
  const auto options = std::make_shared<ReproduceOptions>();
  auto* command = app.add_subcommand(
      "reproduce",
      "The reference paper's figures 7 to 12 and numbers beside ours, into a new results folder");
  command->add_option("--flow-case", options->flow_case, "Case of the flow sensor")
      ->capture_default_str();
  command->add_option("--whisker-case", options->whisker_case, "Case of the whisker sensor")
      ->capture_default_str();
  command->add_option("-o,--output,--out", options->folder,
                      "Results folder; must be new or empty (default: runs/reproduce)");
  add_common_options(*command, options->common);
  command->footer(
      "Example:\n"
      "  vibrissa reproduce -o runs/paper");
  command->callback([options] { reproduce(*options); });
}

}  // namespace vibrissa::apps
