#include <filesystem>
#include <iostream>
#include <memory>
#include <numbers>

#include "apps/command_line/command.h"
#include "apps/command_line/programs.h"
#include "apps/command_line/refused_options.h"
#include "apps/jobs/nominal_input.h"
#include "diagnosis/planning/experiment_plan.h"
#include "report/files/run_folder.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/files/dataset.h"
#include "signals/system/progress.h"
#include "views/records/plan_plots.h"

namespace vibrissa::apps {
namespace {

struct PlanCommand {
  const CLI::App* command = nullptr;
  CommonOptions common;
  NominalInput nominal;
  std::optional<std::string> records;
  std::optional<std::filesystem::path> folder;
  std::optional<double> quiet_s;
  diagnosis::ChannelNoise noise = diagnosis::usual_noise();
  double rate_hz = 500.;
};

void refuse_slow_sampling(const diagnosis::NominalModel& nominal, const double rate_hz) {
  if (nominal.modes.empty()) return;
  const double first_hz = nominal.modes.front().frequency_rad_s / (2. * std::numbers::pi);
  if (rate_hz <= 2. * first_hz)
    throw signals::UserError("--rate: " + signals::to_text(rate_hz) +
                             " Hz is not twice the first mode's " + signals::to_text(first_hz) +
                             " Hz: such records cannot show the sensor's resonance");
}

std::vector<diagnosis::PlannedInput> inputs_without_quiet(
    const PlanCommand& options, const NominalInput::Simulation& simulation) {
  const diagnosis::NominalModel& nominal = simulation.model.nominal;
  if (options.records)
    return diagnosis::inputs_of(nominal, signals::read_dataset(*options.records));
  if (!simulation.dataset.records.empty()) return diagnosis::inputs_of(nominal, simulation.dataset);
  refuse_slow_sampling(nominal, options.rate_hz);
  return diagnosis::usual_inputs(nominal, options.rate_hz);
}

std::vector<diagnosis::PlannedInput> planned_inputs(const PlanCommand& options,
                                                    const NominalInput::Simulation& simulation) {
  std::vector<diagnosis::PlannedInput> inputs = inputs_without_quiet(options, simulation);
  if (options.quiet_s)
    inputs.push_back(diagnosis::quiet_input(*options.quiet_s, inputs.front().sampling_rate_hz));
  return inputs;
}

void write_results(const PlanCommand& options, const diagnosis::ExperimentPlan& plan) {
  const auto folder =
      report::RunFolder::given_or_free(options.folder, std::filesystem::path("results/plan"));
  folder.write_run({.command_line = given_command_line()});
  folder.write_text("plan.json", diagnosis::plan_json(plan));
  folder.write_text("plan.txt", diagnosis::plan_text(plan));
  folder.write_text("detection_limits.csv", views::limits_table(plan).to_csv());
  report::write_figure(folder.path(), views::plan_figure(plan));
  const auto pictures = draw_pictures(folder.path());
  if (!options.common.is_talkative()) return;
  std::cout << pictures.message << "\nResults: " << folder.path().string() << "\n";
}

NominalInput::Simulation simulation_of(const PlanCommand& options, bool show) {
  NominalInput::Simulation simulation = options.nominal.read(show);
  if (!simulation.model.effects.empty())
    throw signals::UserError(*options.nominal.model +
                             ": this is an updated model; a plan starts from the simulation before "
                             "the update: give that one");
  return simulation;
}

void plan(const PlanCommand& options) {
  report::RunFolder::refuse_taken(options.folder);
  if (options.records || options.nominal.simulation)
    refuse_given(*options.command, {"--rate"},
                 std::string("is for planned records, and ") +
                     (options.records ? "--records" : "--sim") + " gives records with their rate");
  const bool show = options.common.is_talkative();
  const NominalInput::Simulation simulation = simulation_of(options, show);
  const diagnosis::NominalModel& nominal = simulation.model.nominal;
  const std::vector<diagnosis::PlannedInput> inputs = planned_inputs(options, simulation);
  signals::Progress progress("trying effects", diagnosis::n_plan_steps(nominal, inputs), show);
  const diagnosis::ExperimentPlan result = diagnosis::plan_experiments(
      nominal, inputs, options.noise, {.on_effect = [&] { progress.advance(); }});
  if (options.common.json)
    std::cout << diagnosis::plan_json(result) << std::flush;
  else
    std::cout << diagnosis::plan_text(result) << std::flush;
  if (options.folder || !options.common.json) write_results(options, result);
}

void add_options(CLI::App& command, PlanCommand& options) {
  command.add_option(
      "--model", options.nominal.model,
      "The simulation as a case file (.prm) or a reduced model (model.json of 'vibrissa run')");
  command.add_option("--sim", options.nominal.simulation,
                     "The simulation as a dataset: a folder of records with dataset.json");
  command.add_option("--records", options.records,
                     "Dataset with the planned inputs (default: those of --sim; for --model two "
                     "multisines and gusts)");
  command
      .add_option("--rate", options.rate_hz,
                  "Sampling rate of the records planned for --model [Hz]")
      ->check(positive_number())
      ->capture_default_str();
  command
      .add_option("--quiet-record", options.quiet_s,
                  "Length of a further planned record at rest [s]")
      ->check(CLI::Range(1., 3600.));
  command
      .add_option("--moment-noise", options.noise.moment_n_m,
                  "Noise of the base moment, rms of each data point [N m]")
      ->check(positive_number())
      ->capture_default_str();
  command
      .add_option("--acceleration-noise", options.noise.acceleration_m_s2,
                  "Noise of the accelerometer, rms of each data point [m/s^2]")
      ->check(positive_number())
      ->capture_default_str();
  command.add_option("-o,--out,--output", options.folder,
                     "New folder for plan.json, detection_limits.csv and the picture (default: "
                     "results/plan, or results/plan-2, ... if it exists)");
}

}  // namespace

void add_plan_command(CLI::App& app) {
  const auto options = std::make_shared<PlanCommand>();
  auto* command = app.add_subcommand("plan",
                                     "Tells, before there are data, which effects an experiment "
                                     "can detect and distinguish, and what to measure first");
  options->command = command;
  add_options(*command, *options);
  add_common_options(*command, options->common);
  command->footer(
      "Example:\n  vibrissa plan --sim simulated --moment-noise 1e-6 --out plan\n"
      "Exit status: 0 done, 2 bad input.");
  command->callback([options] { plan(*options); });
}

}  // namespace vibrissa::apps
