#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include "apps/command_line/command.h"
#include "apps/command_line/programs.h"
#include "apps/command_line/record_options.h"
#include "apps/command_line/refused_options.h"
#include "apps/commands/resonance_diagnosis.h"
#include "apps/jobs/nominal_input.h"
#include "diagnosis/diagnosis.h"
#include "diagnosis/model/updated_model.h"
#include "diagnosis/planning/next_experiment.h"
#include "report/files/run_folder.h"
#include "signals/base/error.h"
#include "signals/system/progress.h"
#include "views/records/diagnosis_page.h"
#include "views/records/diagnosis_plots.h"

namespace vibrissa::apps {
namespace {

struct DiagnoseCommand {
  const CLI::App* command = nullptr;
  CommonOptions common;
  NominalInput simulation;
  ResonanceInput figures;  // in place of records
  RecordOptions record;    // of the real sensor
  std::optional<std::string> real;
  std::optional<std::filesystem::path> folder;
  std::size_t max_effects = diagnosis::SearchOptions{}.max_effects;
  std::vector<std::string> possible_experiments;
  double simulation_accuracy = diagnosis::usual_simulation_accuracy;
  double time_limit_s = 300.;
};

constexpr std::size_t whole_verdict = 1000;

void write_results(const DiagnoseCommand& options, const diagnosis::Diagnosis& diagnosis) {
  const auto folder =
      report::RunFolder::given_or_free(options.folder, std::filesystem::path("results/diagnosis"));
  folder.write_run({.command_line = given_command_line()});
  folder.write_text("diagnosis.json", diagnosis::diagnosis_json(diagnosis));
  folder.write_text("updated_model.json", diagnosis::updated_model_json(diagnosis.updated));
  folder.write_text("verdict.txt", diagnosis::verdict_text(diagnosis, whole_verdict));
  folder.write_text("ranking.csv", views::ranking_table(diagnosis).to_csv());
  for (const report::Figure& figure : views::diagnosis_plots(diagnosis))
    report::write_figure(folder.path(), figure);
  const auto pictures = draw_pictures(folder.path());
  report::write_page(folder.path(), views::diagnosis_page(diagnosis));
  if (!options.common.is_talkative()) return;
  std::cout << pictures.message << "\nResults: " << folder.path().string() << "\n";
  if (diagnosis.verdict != "none" && diagnosis.verdict != diagnosis::outside_catalogue)
    std::cout << "Corrected simulation, with all changes of the table: "
              << (folder.path() / "updated_model.json").string()
              << " (for --model of diagnose, simulate, separate)\n";
}

/// A simulation that is compared with itself has no gap, and noise of its own that no other has.
void refuse_the_same(const signals::Dataset& simulated, const signals::Dataset& real) {
  const auto is_simulated = [&](const signals::DatasetRecord& measured) {
    const auto moment = measured.record.channel(signals::channel::base_moment);
    return std::any_of(simulated.records.begin(), simulated.records.end(),
                       [&](const signals::DatasetRecord& entry) {
                         const auto other = entry.record.channel(signals::channel::base_moment);
                         return std::equal(moment.begin(), moment.end(), other.begin(),
                                           other.end());
                       });
  };
  if (!real.records.empty() && std::ranges::all_of(real.records, is_simulated))
    throw signals::UserError(
        "--real and --sim hold the same samples, so there is no gap; give records of the real "
        "sensor as --real");
}

/// A rotation and a deflection are in proportion, but the factor is not known.
void refuse_other_motion(const signals::Dataset& simulated, const signals::Dataset& real) {
  const auto is_rotation = [](const signals::DatasetResponse& entry) {
    return entry.quantity == signals::ResponseQuantity::rotation;
  };
  for (const signals::DatasetResponse& measured : real.responses)
    for (const signals::DatasetResponse& entry : simulated.responses)
      if (is_rotation(measured) != is_rotation(entry))
        throw signals::UserError("response '" + measured.name + "' is " +
                                 to_string(measured.quantity) + " and the simulated one '" +
                                 entry.name + "' is " + to_string(entry.quantity) +
                                 "; give responses of the same quantity");
}

void diagnose_records(const DiagnoseCommand& options) {
  if (!options.real)
    throw signals::UserError(
        "give the records of the real sensor as --real DATASET, or two resonances as --resonance "
        "SIMULATED_HZ:MEASURED_HZ");
  diagnosis::check_menu_names(options.possible_experiments);
  const bool show = options.common.is_talkative();
  options.simulation.check_one_is_given();
  options.record.refuse_unused(*options.real);
  signals::ReadOptions reading = options.record.read_options();
  reading.takes_responses = true;
  const signals::Dataset real = signals::read_dataset(*options.real, reading);
  const NominalInput::Simulation simulation = options.simulation.read(show, reading);
  for (const signals::Dataset* dataset : {&real, &simulation.dataset})
    for (const std::string& words : signals::short_readings(dataset->readings))
      if (show) std::cerr << words << std::endl;
  refuse_the_same(simulation.dataset, real);
  refuse_other_motion(simulation.dataset, real);
  // About forty single effects and combinations are fitted.
  constexpr std::size_t usual_fits = 75;
  signals::Progress progress("fitting effects", usual_fits, show);
  diagnosis::DiagnoseOptions settings;
  settings.simulated_rate_hz = simulation.sampling_rate_hz();
  settings.search.max_effects = options.max_effects;
  settings.search.time_limit_s = options.time_limit_s;
  settings.simulation_accuracy = options.simulation_accuracy;
  settings.possible_experiments = options.possible_experiments;
  settings.search.on_fit = [&] { progress.advance(); };
  const diagnosis::Diagnosis diagnosis = diagnosis::diagnose(simulation.model, real, settings);
  if (options.common.json)
    std::cout << diagnosis::diagnosis_json(diagnosis) << std::endl;
  else
    std::cout << diagnosis::verdict_text(diagnosis) << std::endl;
  if (options.folder || !options.common.json) write_results(options, diagnosis);
}

void diagnose(const DiagnoseCommand& options) {
  report::RunFolder::refuse_taken(options.folder);
  if (!options.figures.is_given()) return diagnose_records(options);
  if (options.real || options.simulation.simulation)
    throw signals::UserError(
        "--resonance, --damping and --example compare resonances, --real and --sim compare "
        "records; give either resonances or records");
  const std::string reason = "is for records, and two resonances are compared";
  refuse_given(*options.command, record_option_names(), reason);
  refuse_given(*options.command,
               {"--simulation-accuracy", "--time-limit", "--max-effects", "--bench-can"}, reason);
  diagnose_resonances(options.figures, options.simulation, options.common, options.folder);
}

}  // namespace

namespace {

std::string known_experiments() {
  constexpr std::size_t width = 22;
  std::string text;
  for (const diagnosis::MenuEntry& entry : diagnosis::experiment_menu())
    text += "  " + entry.name + std::string(width - entry.name.size(), ' ') + entry.what + "\n";
  return text;
}

}  // namespace

void add_diagnose_command(CLI::App& app) {
  const auto options = std::make_shared<DiagnoseCommand>();
  auto* command =
      app.add_subcommand("diagnose",
                         "Finds why records differ from the simulation: the cause, where the gap "
                         "lies, and the improvement once the cause is added");
  options->command = command;
  command->add_option(
      "--model", options->simulation.model,
      "The simulation as a case file (.prm), a reduced model or an updated model (.json); this "
      "or --sim");
  command->add_option(
      "--sim", options->simulation.simulation,
      "The simulation as records: one file, or a folder of records with dataset.json; this or "
      "--model");
  command->add_option("--real", options->real,
                      "Records of the real sensor: one file, or a folder of records with "
                      "dataset.json. --column and --rate say how its files are read, and those of "
                      "--sim where they lack the channels' names");
  options->record.add_to(*command);
  options->figures.add_to(*command);
  command->add_option(
      "-o,--out,--output", options->folder,
      "New folder for report.html, diagnosis.json, updated_model.json, ranking.csv and pictures "
      "(default: results/diagnosis, or results/diagnosis-2, ... if it exists)");
  command
      ->add_option("--simulation-accuracy", options->simulation_accuracy,
                   "Relative error of the moment that a simulation keeps when all its values are "
                   "right, 0.01 for "
                   "1 %; causes of smaller errors are not named")
      ->capture_default_str()
      ->check(CLI::Range(1e-4, 0.3));
  command
      ->add_option("--time-limit", options->time_limit_s,
                   "Longest search for causes [s]; the answer so far is given after it")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--max-effects", options->max_effects,
                   "Largest number of missing effects in one answer; wrong calibrations "
                   "(stiffness, damping, mass, gains, drag) do not count")
      ->check(CLI::Range(1, 5))
      ->capture_default_str();
  command
      ->add_option(
          "--bench-can", options->possible_experiments,
          "Experiments that your bench can do, comma-separated; 'Measure next' proposes one "
          "of them (default: all of the list below)")
      ->delimiter(',');
  add_common_options(*command, options->common);
  command->footer(
      "Experiments for --bench-can:\n" + known_experiments() +
      "Examples:\n  vibrissa diagnose --sim simulated --real bench --out diagnosis\n"
      "  vibrissa diagnose --model case.prm --real bench.csv --column 'base_acceleration=ax[g]' "
      "\\\n"
      "    --column 'base_moment=hall[uT]*0.18[N m/T]' --column 'time=t[s]'\n"
      "  vibrissa diagnose --resonance 37.32:31.47 --damping 0.05:0.027\n"
      "  vibrissa diagnose --example paper-gap\n"
      "Exit status: 0 an answer, 2 bad input, 3 too little data to say anything.");
  command->callback([options] { diagnose(*options); });
}

}  // namespace vibrissa::apps
