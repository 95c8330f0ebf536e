#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/case_file.h"
#include "apps/command.h"
#include "apps/diagnosis_figures.h"
#include "apps/sensor_model.h"
#include "diagnosis/diagnosis_json.h"
#include "diagnosis/mended_model_json.h"
#include "diagnosis/nominal_from_model.h"
#include "diagnosis/nominal_identification.h"
#include "diagnosis/resonance_gap_text.h"
#include "diagnosis/resonance_model.h"
#include "fem/solver_session.h"
#include "report/pictures.h"
#include "report/run_folder.h"
#include "signals/error.h"
#include "signals/number_text.h"
#include "signals/progress.h"

namespace vibrissa::apps {
namespace {

struct DiagnoseCommand {
  CommonOptions common;
  std::optional<std::string> model, simulation, real;
  std::optional<std::string> resonance, damping, example;  // figures in place of records
  std::optional<std::filesystem::path> folder;
  std::size_t max_effects = 3;
};

signals::ReducedModel solve_case(const std::string& file, bool show_progress) {
  Case parameters = CaseFile(file).read();
  const fem::SolverSession session;
  return make_reduced_model(fem::Sensor(parameters.sensor), parameters.sensor, show_progress);
}

signals::ReducedModel given_model(const DiagnoseCommand& options) {
  const bool is_case = std::filesystem::path(*options.model).extension() == ".prm";
  const bool show = !options.common.quiet && !options.common.json;
  return is_case ? solve_case(*options.model, show) : signals::read_reduced_model(*options.model);
}

/// The simulation and the rate of its records, 0 when it is a model.
std::pair<diagnosis::MendedModel, double> simulation(const DiagnoseCommand& options) {
  if (options.model.has_value() == options.simulation.has_value())
    throw signals::UserError(
        "give the simulation either as --model CASE.prm|model.json or as --sim DATASET");
  if (options.simulation) {
    const signals::Dataset dataset = signals::read_dataset(*options.simulation);
    return {diagnosis::identify_nominal(dataset),
            dataset.records.front().record.sampling_rate_hz()};
  }
  if (diagnosis::is_mended_model(*options.model))
    return {diagnosis::read_mended_model(*options.model), 0.};
  return {diagnosis::nominal_from(given_model(options)), 0.};
}

void write_results(const DiagnoseCommand& options, const diagnosis::Diagnosis& diagnosis) {
  const auto folder =
      report::RunFolder::given_or_free(options.folder, std::filesystem::path("results/diagnosis"));
  folder.write_run({.command_line = given_command_line()});
  folder.write_text("diagnosis.json", diagnosis::diagnosis_json(diagnosis));
  folder.write_text("mended_model.json", diagnosis::mended_model_json(diagnosis.mended));
  folder.write_text("verdict.txt", diagnosis::verdict_text(diagnosis));
  folder.write_text("ranking.csv", ranking_table(diagnosis).to_csv());
  for (const report::Figure& figure : diagnosis_figures(diagnosis))
    report::write_figure(folder.path(), figure);
  const auto pictures = report::draw_pictures(folder.path());
  if (options.common.json || options.common.quiet) return;
  std::cout << pictures.message << "\nResults: " << folder.path().string() << "\n";
}

/// "SIMULATED:MEASURED".
std::array<double, 2> simulated_and_measured(const std::string& option, const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon != std::string::npos) {
    const auto simulated = signals::to_number(text.substr(0, colon));
    const auto measured = signals::to_number(text.substr(colon + 1));
    if (simulated && measured) return {*simulated, *measured};
  }
  throw signals::UserError(option + " '" + text +
                           "' is not SIMULATED:MEASURED: give two numbers with a colon between");
}

bool by_figures(const DiagnoseCommand& options) {
  return options.resonance || options.damping || options.example;
}

void check_figures_alone(const DiagnoseCommand& options) {
  if (options.real || options.simulation)
    throw signals::UserError(
        "--resonance, --damping and --example compare figures, --real and --sim records: give "
        "either figures or records");
  if (options.example && (options.resonance || options.damping))
    throw signals::UserError(
        "--example has its own figures: leave out --resonance and --damping, or --example");
  if (options.damping && !options.resonance)
    throw signals::UserError("--damping needs --resonance SIMULATED_HZ:MEASURED_HZ beside it");
  if (options.example && *options.example != "paper-gap")
    throw signals::UserError(signals::unknown_name("example", *options.example, {"paper-gap"}));
}

diagnosis::ResonanceExample given_figures(const DiagnoseCommand& options) {
  diagnosis::ResonanceExample given;
  if (options.example) {
    given = diagnosis::paper_gap();
  } else {
    const auto hz = simulated_and_measured("--resonance", *options.resonance);
    given.simulated.frequency_hz = hz[0];
    given.measured.frequency_hz = hz[1];
  }
  if (options.damping) {
    const auto ratios = simulated_and_measured("--damping", *options.damping);
    given.simulated.damping_ratio = ratios[0];
    given.measured.damping_ratio = ratios[1];
  }
  if (options.model)
    given.model =
        diagnosis::resonance_model_from(given_model(options), given.simulated.frequency_hz);
  return given;
}

void diagnose_figures(const DiagnoseCommand& options) {
  check_figures_alone(options);
  const diagnosis::ResonanceExample given = given_figures(options);
  const diagnosis::ResonanceDiagnosis diagnosis =
      diagnosis::explain_resonance_gap(given.simulated, given.measured, given.model);
  const std::string document = diagnosis::resonance_gap_json(diagnosis).dump(2) + "\n";
  const std::string text = diagnosis::resonance_gap_text(diagnosis);
  std::cout << (options.common.json ? document : text) << std::flush;
  if (!options.folder) return;
  const auto folder =
      report::RunFolder::given_or_free(options.folder, std::filesystem::path("results/diagnosis"));
  folder.write_run({.command_line = given_command_line()});
  folder.write_text("resonance_gap.json", document);
  folder.write_text("verdict.txt", text);
}

void diagnose_records(const DiagnoseCommand& options) {
  if (!options.real)
    throw signals::UserError(
        "give the records of the real sensor as --real DATASET; without records give the figures "
        "alone as --resonance SIMULATED_HZ:MEASURED_HZ");
  const auto [model, rate_hz] = simulation(options);
  const signals::Dataset real = signals::read_dataset(*options.real);
  // About forty single effects and combinations are fitted.
  constexpr std::size_t usual_fits = 75;
  signals::Progress progress("fitting effects", usual_fits,
                             !options.common.quiet && !options.common.json);
  diagnosis::DiagnoseOptions settings;
  settings.simulated_rate_hz = rate_hz;
  settings.search.max_effects = options.max_effects;
  settings.search.on_fit = [&] { progress.advance(); };
  const diagnosis::Diagnosis diagnosis = diagnosis::diagnose(model, real, settings);
  if (options.common.json)
    std::cout << diagnosis::diagnosis_json(diagnosis) << std::endl;
  else
    std::cout << diagnosis::verdict_text(diagnosis) << std::endl;
  if (options.folder || !options.common.json) write_results(options, diagnosis);
}

}  // namespace

void add_diagnose_command(CLI::App& app) {
  const auto options = std::make_shared<DiagnoseCommand>();
  auto* command = app.add_subcommand(
      "diagnose",
      "Why the records differ from the simulation: where, which effect, how far the gap closes");
  command->add_option(
      "--model", options->model,
      "The simulation as a case file (.prm), a reduced model or a mended model (.json)");
  command->add_option("--sim", options->simulation,
                      "The simulation as a dataset: a folder of records with dataset.json");
  command->add_option("--real", options->real, "Dataset of the real sensor");
  command->add_option("--resonance", options->resonance,
                      "SIMULATED_HZ:MEASURED_HZ: the first resonances, when there are no records");
  command->add_option("--damping", options->damping,
                      "SIMULATED:MEASURED: damping ratios beside --resonance");
  command->add_option("--example", options->example,
                      "Built-in figures: paper-gap, the reference study's own gap");
  command->add_option("-o,--out", options->folder,
                      "New folder for diagnosis.json, mended_model.json, ranking.csv and pictures");
  command
      ->add_option("--max-effects", options->max_effects,
                   "Most effects that are combined beside retuned parameters")
      ->check(CLI::Range(1, 3))
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->footer(
      "Examples:\n  vibrissa diagnose --sim simulated --real bench --out diagnosis\n"
      "  vibrissa diagnose --resonance 37.32:31.47 --damping 0.05:0.027 --model model.json\n"
      "  vibrissa diagnose --example paper-gap\n"
      "Exit status: 0 an answer, 2 bad input, 3 too little data to say anything.");
  command->callback([options] {
    if (by_figures(*options))
      diagnose_figures(*options);
    else
      diagnose_records(*options);
  });
}

}  // namespace vibrissa::apps
