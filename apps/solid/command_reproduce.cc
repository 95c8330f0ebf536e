#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/command_line/command.h"
#include "apps/command_line/programs.h"
#include "report/files/run_folder.h"
#include "reproduction/paper_figures.h"
#include "reproduction/paper_numbers.h"
#include "reproduction/paper_rig.h"
#include "reproduction/reproduction_page.h"

namespace vibrissa::apps {

namespace {

struct ReproduceOptions {
  CommonOptions common;
  std::string flow_case = "cases/flow_sensor.prm", whisker_case = "cases/whisker_sensor.prm";
  std::optional<std::string> folder;
};

reproduction::Reproduction reproduce_paper(const ReproduceOptions& options,
                                           const bool show_progress) {
  auto sensors =
      reproduction::make_paper_sensors(options.flow_case, options.whisker_case, show_progress);
  auto simulation = reproduction::simulate_paper_simulation(sensors);
  auto experiment = reproduction::simulate_paper_experiment(sensors);
  auto readings = reproduction::compare_fdaf_readings(sensors, experiment);
  using separation::IdentifyMethod;
  const auto whisker = reproduction::paper_simulation_records(sensors.whisker).vibration_only;
  const double flow_srivc =
      reproduction::held_out_fit_percent(simulation.records.vibration_only, IdentifyMethod::srivc);
  return {.sensors = std::move(sensors),
          .simulation = std::move(simulation),
          .experiment = std::move(experiment),
          .flow_srivc_fit_percent = flow_srivc,
          .whisker_fit_percent =
              reproduction::held_out_fit_percent(whisker, IdentifyMethod::output_error),
          .whisker_srivc_fit_percent =
              reproduction::held_out_fit_percent(whisker, IdentifyMethod::srivc),
          .readings = std::move(readings)};
}

std::vector<report::Figure> figures_of(const reproduction::Reproduction& result) {
  return {reproduction::step_responses(result.sensors.wire),
          reproduction::steady_responses(result.sensors),
          reproduction::base_responses(result.sensors),
          reproduction::estimates(result.simulation, "figure_10_simulation",
                                  "Simulation: wind and vibration, true and separated"),
          reproduction::estimates(result.experiment, "figure_11_experiment",
                                  "Simulated experiment: wind and vibration, true and separated"),
          reproduction::experiment_spectra(result.experiment)};
}

std::string report_text(const reproduction::Reproduction& result) {
  return "The paper's numbers\n\n" +
         reproduction::numbers_table(reproduction::paper_numbers(result)).to_markdown() +
         "\nThe \"experiment\" is simulated with the published values and noise of the built "
         "sensor.\n" +
         "\nSettings of the adaptive filter, tried on the simulated experiment\n\n" +
         reproduction::readings_table(result.readings).to_markdown() + "\n" +
         reproduction::explain(result.readings) + "\n" + "\nSimulation\n\n" +
         views::separation_table(result.simulation.separated).to_markdown() +
         "\nSimulated experiment\n\n" +
         views::separation_table(result.experiment.separated).to_markdown() + "\n" +
         views::metric_notes(reproduction::paper::settling_s) + "\n";
}

void reproduce(const ReproduceOptions& options) {
  report::RunFolder::refuse_taken(options.folder);
  const bool quiet = options.common.quiet || options.common.json;
  const reproduction::Reproduction result = reproduce_paper(options, !quiet);
  const auto folder = report::RunFolder::given_or_free(options.folder, "results/reproduce");
  folder.write_run({given_command_line(), {}, {}});
  const std::string text = report_text(result);
  folder.write_text("reproduction.md", text);
  folder.write_text("numbers.csv",
                    reproduction::numbers_table(reproduction::paper_numbers(result)).to_csv());
  folder.write_text("fdaf_readings.csv", reproduction::readings_table(result.readings).to_csv());
  const std::vector<report::Figure> figures = figures_of(result);
  for (const report::Figure& figure : figures) report::write_figure(folder.path(), figure);
  nlohmann::json document = reproduction::reproduction_json(result);
  document["folder"] = folder.path().string();
  folder.write_json("summary.json", document);
  const auto pictures = draw_pictures(folder.path());
  report::write_page(folder.path(), reproduction::reproduction_page(result, figures));
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
      "Reproduces figures 7 to 12 and the numbers of the reference paper (Routray et al. 2024)");
  command->add_option("--flow-case", options->flow_case, "Case of the flow sensor")
      ->capture_default_str();
  command->add_option("--whisker-case", options->whisker_case, "Case of the whisker sensor")
      ->capture_default_str();
  command->add_option("-o,--output,--out", options->folder,
                      "Results folder; must be new or empty (default: results/reproduce)");
  add_common_options(*command, options->common);
  command->footer(
      "Example:\n"
      "  vibrissa reproduce -o results/paper");
  command->callback([options] { reproduce(*options); });
}

}  // namespace vibrissa::apps
