#include <iostream>
#include <memory>

#include "apps/command_line/command.h"
#include "apps/solid/jobs/run_job.h"
#include "fem/linalg/processes.h"

namespace vibrissa::apps {

namespace {

struct RunOptions {
  CommonOptions common;
  CaseOptions chosen;
};

void print_outcome(const RunOutcome& outcome, const bool quiet) {
  const auto& summary = outcome.summary;
  const auto number = [](const nlohmann::json& value) {
    return report::Cell(value.get<double>()).rounded(4);
  };
  std::cout << "First resonance " << number(summary["modes"][0]["frequency_hz"]) << " Hz";
  if (summary.contains("calibration_note")) {
    std::cout << " (" << summary["calibration_note"].get<std::string>() << ")";
  }
  const auto& identified = summary["identification"];
  std::cout << "\nBase vibration response model of order " << identified["order"] << ": fit "
            << number(identified["fit_percent"]) << " % on held-out data\n\n"
            << views::separation_table(outcome.separated).to_text();
  if (!quiet) std::cout << "\n";
  if (!outcome.pictures.message.empty()) std::cout << outcome.pictures.message << "\n";
  std::cout << "Results: " << outcome.folder.string() << "\n";
  for (const auto& picture : outcome.pictures.made) {
    std::cout << "  " << (outcome.folder / picture).string() << "\n";
  }
}

}  // namespace

void add_run_command(CLI::App& app) {
  const auto options = std::make_shared<RunOptions>();
  auto* command = app.add_subcommand("run",
                                     "Simulates a sensor, identifies its vibration response, "
                                     "separates wind from vibration; writes a results folder");
  options->chosen.add_to(*command, sensor_case::CaseUse::whole_job);
  options->chosen.add_folder_to(*command);
  add_common_options(*command, options->common);
  command->footer(
      "Examples:\n"
      "  vibrissa run sensor.prm\n"
      "  vibrissa run sensor.prm --base-acceleration bus.csv --column 'base_acceleration=az[g]' "
      "\\\n"
      "    --remove-mean base_acceleration --output results/bus");
  command->callback([options] {
    const bool quiet = options->common.quiet || options->common.json;
    const RunOutcome outcome = run_job(options->chosen, given_command_line(), quiet);
    if (!fem::is_first_process()) return;
    if (options->common.json) {
      print_json(outcome.summary);
    } else {
      print_outcome(outcome, options->common.quiet);
    }
  });
}

}  // namespace vibrissa::apps
