#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/command_line/command.h"
#include "apps/command_line/programs.h"
#include "apps/command_line/record_options.h"
#include "apps/command_line/refused_options.h"
#include "report/files/run_folder.h"
#include "reproduction/paper_rig.h"
#include "reproduction/paper_sensors.h"
#include "signals/system/progress.h"
#include "suite/separation_suite.h"

namespace vibrissa::apps {

namespace {

namespace fs = std::filesystem;

struct SuiteOptions {
  const CLI::App* command = nullptr;
  CommonOptions common;
  std::string flow_case = "cases/flow_sensor.prm";
  std::string recordings;
  std::vector<std::string> datasets;
  RecordOptions record;
  std::optional<std::string> truth_column, folder;
};

suite::Scenario dataset_scenario(const SuiteOptions& options, const std::string& file) {
  suite::Scenario scenario{
      fs::path(file).filename(), "given record", options.record.read(file), {}, {}};
  if (options.truth_column) {
    scenario.true_wind_moment_n_m = options.record.read_column(file, *options.truth_column);
  }
  return scenario;
}

std::vector<suite::Scenario> scenarios_of(const SuiteOptions& options, const bool show_progress,
                                          std::vector<std::string>& left_out) {
  auto sensors = reproduction::make_flow_sensors(options.flow_case, show_progress);
  suite::ScenarioRig rig;
  rig.sensor = std::move(sensors.built);
  rig.simulated_sensor = std::move(sensors.simulated);
  rig.recordings = options.recordings;
  auto scenarios = suite::make_scenarios(rig, left_out);
  for (const auto& file : options.datasets) scenarios.push_back(dataset_scenario(options, file));
  return scenarios;
}

std::string report_text(const std::vector<suite::ScenarioResult>& results,
                        const std::vector<std::string>& left_out) {
  std::string text = suite::sdr_table(results).to_markdown() + "\n" +
                     suite::suite_table(results).to_markdown() + "\n" +
                     views::metric_notes(reproduction::paper::settling_s) + "\n";
  for (const auto& line : left_out) text += "Left out: " + line + "\n";
  return text;
}

void benchmark_separation(const SuiteOptions& options) {
  report::RunFolder::refuse_taken(options.folder);
  if (options.datasets.empty()) {
    refuse_given(*options.command, {"--truth-column"}, "needs --dataset");
    refuse_given(*options.command, record_option_names(), "needs --dataset");
  }
  const bool quiet = options.common.quiet || options.common.json;
  std::vector<std::string> left_out;
  const auto scenarios = scenarios_of(options, !quiet, left_out);
  const auto folder =
      report::RunFolder::given_or_free(options.folder, "results/benchmark_separation");
  folder.write_run({given_command_line(), {}, {}});
  signals::Progress progress("scenarios", scenarios.size(), !quiet);
  std::vector<suite::ScenarioResult> results;
  for (const auto& scenario : scenarios) {
    results.push_back(suite::separate_by_all(scenario));
    progress.advance();
  }
  nlohmann::json document = suite::suite_json(results);
  document["left_out"] = left_out;
  document["folder"] = folder.path().string();
  folder.write_text("separation.md", report_text(results, left_out));
  folder.write_text("separation.csv", suite::suite_table(results).to_csv());
  folder.write_json("summary.json", document);
  report::write_figure(folder.path(), suite::suite_figure(results));
  const auto pictures = draw_pictures(folder.path());
  if (options.common.json) {
    print_json(document);
    return;
  }
  std::cout << suite::sdr_table(results).to_text();
  for (const auto& line : left_out) std::cout << "Left out: " << line << "\n";
  std::cout << pictures.message << "\nAll metrics: " << folder.path().string()
            << "/separation.md\n";
}

}  // namespace

void add_benchmark_command(CLI::App& app) {
  const auto options = std::make_shared<SuiteOptions>();
  auto* benchmark = app.add_subcommand("benchmark", "Compares methods on a suite of scenarios");
  benchmark->footer("Example:\n  vibrissa benchmark separation");
  benchmark->require_subcommand(1);
  auto* command = benchmark->add_subcommand(
      "separation",
      "Runs all separation methods on all scenarios; writes one table and one picture");
  options->command = command;
  command->add_option("--flow-case", options->flow_case, "Case of the flow sensor")
      ->capture_default_str();
  command->add_option("--recordings", options->recordings,
                      "Folder of recorded vibration and wind for the scenarios that need it");
  command->add_option("--dataset", options->datasets,
                      "Record file that becomes one more scenario (may be repeated)");
  command->add_option("--truth-column", options->truth_column,
                      "Column of the datasets that holds the true wind moment [N m]");
  command->add_option(
      "-o,--output,--out", options->folder,
      "Results folder; must be new or empty (default: results/benchmark_separation)");
  options->record.add_to(*command);
  add_common_options(*command, options->common);
  command->footer(
      "Examples:\n"
      "  vibrissa benchmark separation\n"
      "  vibrissa benchmark separation --dataset bench.csv --truth-column wind_moment_N_m");
  command->callback([options] { benchmark_separation(*options); });
}

}  // namespace vibrissa::apps
