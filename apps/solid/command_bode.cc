#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/command_line/command.h"
#include "apps/command_line/programs.h"
#include "apps/command_line/record_options.h"
#include "apps/command_line/refused_options.h"
#include "apps/command_line/results.h"
#include "apps/jobs/measured_response.h"
#include "apps/solid/jobs/case_options.h"
#include "case/rig.h"
#include "fem/linalg/solver_session.h"
#include "fem/sensor/reduction.h"
#include "separation/nonlinear/nonlinear_bvrm.h"
#include "signals/base/error.h"
#include "signals/files/response_file.h"
#include "signals/system/output_file.h"
#include "views/records/bode_data.h"

namespace vibrissa::apps {

namespace {

struct BodeOptions {
  const CLI::App* command = nullptr;
  CommonOptions common;
  RecordOptions record;
  std::string input;
  CaseOptions chosen;
  std::optional<std::string> folder, response_file;
  ResponseOptions response;
  std::vector<std::string> realisations;
  double low_hz = 1., high_hz = 200.;
};

std::vector<double> resonances(const signals::ReducedModel& model) {
  std::vector<double> f;
  for (const auto& mode : model.modes) f.push_back(mode.frequency_hz);
  return f;
}

views::BodeCurve of_model(const signals::ReducedModel& model, const BodeOptions& options) {
  return views::bode_curve(
      model, views::bode_frequencies(options.low_hz, options.high_hz, resonances(model)));
}

views::BodeCurve of_case(const BodeOptions& options) {
  CaseOptions chosen = options.chosen;
  chosen.case_file = options.input;
  const sensor_case::Case parameters = chosen.load().read();
  sensor_case::refuse_gravity(parameters, "the reduced model");
  const fem::SolverSession session;
  auto model = fem::reduce(fem::Sensor(parameters.sensor));
  model.name = "simulated sensor";
  return of_model(model, options);
}

/// The linear part of a model with a joint law; the words say so.
MeasuredResponse of_nonlinear(const BodeOptions& options) {
  const separation::NonlinearBvrm model = separation::read_nonlinear_bvrm(options.input);
  const separation::Bvrm linear = separation::at_small_amplitude(model);
  std::vector<double> resonance_hz;
  for (const auto& mode : linear.modes) resonance_hz.push_back(mode.frequency_hz());
  MeasuredResponse out{
      .curve = views::bode_curve(
          linear, views::bode_frequencies(options.low_hz, options.high_hz, resonance_hz)),
      .evidence = {},
      .detection = {},
      .words = {}};
  out.curve.label = "at small amplitude";
  std::string law;
  for (const auto& term : model.law) law += (law.empty() ? "" : ", ") + term.name();
  out.words = "the diagram is of the linear part at small amplitude: mode " +
              std::to_string(model.mode + 1) + " has a law (" + law +
              "), so no diagram is right at all amplitudes; 'vibrissa separate' uses the law";
  return out;
}

MeasuredResponse of_record(const BodeOptions& options) {
  if (!options.realisations.empty())
    refuse_given(*options.command, {"--join"},
                 "joins one record, and --realisation gives several; join each of them first by "
                 "'vibrissa convert --join'");
  std::vector<signals::Record> records = {options.record.read(options.input)};
  for (const auto& file : options.realisations) records.push_back(options.record.read(file));
  return measure_response(records, options.response);
}

MeasuredResponse make_response(const BodeOptions& options) {
  if (!(options.low_hz > 0. && options.low_hz < options.high_hz)) {
    throw signals::UserError("--low must be positive and below --high");
  }
  const auto extension = std::filesystem::path(options.input).extension();
  if (extension != ".prm" && !options.chosen.is_plain())
    throw signals::UserError("--set is for case files (.prm), which " + options.input + " is not");
  if (extension != ".prm" && extension != ".json") {
    refuse_given(*options.command, {"--low", "--high"},
                 "is for the diagram of a model, and " + options.input + " is a record");
    if (options.response.method.value_or("welch") != "welch" || options.response.period_samples > 0)
      refuse_given(*options.command, {"--segment"}, "is for --method welch");
    return of_record(options);
  }
  const std::string reason = "is for records, and " + options.input + " is a model";
  refuse_given(*options.command, {"--method", "--period", "--realisation", "--segment"}, reason);
  refuse_given(*options.command, record_option_names(), reason);
  if (extension == ".json" && separation::is_nonlinear_bvrm(options.input))
    return of_nonlinear(options);
  return {extension == ".prm" ? of_case(options)
                              : of_model(signals::read_reduced_model(options.input), options),
          {},
          {},
          {}};
}

void write_folder(const std::string& folder, const MeasuredResponse& measured) {
  signals::make_new_folder(folder);
  report::write_figure(folder, views::bode_figure({measured.curve}));
  const auto write = [&](const std::string& name, const report::Table& table) {
    signals::write_file(std::filesystem::path(folder) / name,
                        [&](std::ostream& out) { out << table.to_csv(); });
  };
  write("response.csv", response_table(measured));
  if (!measured.detection.empty()) write("detection.csv", detection_table(measured.detection));
}

void bode(const BodeOptions& options) {
  FileNames inputs(options.realisations.begin(), options.realisations.end());
  inputs.push_back(options.input);
  refuse_overwriting(inputs, {options.response_file});
  const MeasuredResponse measured = make_response(options);
  if (options.response_file)
    signals::formats::write_response(*options.response_file, measured.curve.response,
                                     measured.curve.label);
  const bool is_told = options.folder || options.response_file || options.common.json;
  const std::optional<std::string> folder =
      is_told ? options.folder : free_results_folder("bode").string();
  if (folder) {
    write_folder(*folder, measured);
    const auto pictures = draw_pictures(*folder);
    if (!options.common.json) {
      std::cout << "response: " << *folder << "/response.csv\n"
                << pictures.message << "\n"
                << measured.words << (measured.words.empty() ? "" : "\n");
    }
  }
  if (options.common.json) {
    print_json(response_json(measured));
    return;
  }
  if (options.response_file && !options.common.quiet)
    std::cout << "wrote " << *options.response_file << ": "
              << measured.curve.response.frequency_hz.size() << " frequencies\n";
}

}  // namespace

void add_bode_command(CLI::App& app) {
  const auto options = std::make_shared<BodeOptions>();
  auto* command = app.add_subcommand("bode",
                                     "Computes the frequency response base acceleration -> base "
                                     "moment of a case, a model or a record");
  command
      ->add_option(
          "input", options->input,
          "Case file (.prm), reduced model (model.json of 'vibrissa run'), model of 'vibrissa "
          "identify --nonlinear' (drawn at small amplitude) or record")
      ->required();
  options->command = command;
  options->chosen.add_settings_to(*command, sensor_case::CaseUse::response);
  command->add_option(
      "-o,--output,--out", options->folder,
      "New folder for plot, picture and response.csv (default: results/bode, or results/bode-2, "
      "... if it exists; with --json or --response only if this option is given)");
  command->add_option("--response", options->response_file,
                      "Also write the response for other programs: .uff, .unv, .uf58 (Universal "
                      "File, type 58), .mat or .csv");
  command->add_option("--period", options->response.period_samples,
                      "Period of a periodic record in steady state [samples]; all whole periods "
                      "are used, counted from the end");
  command->add_option(
      "--method", options->response.method,
      "For records (default: periods with --period, else welch):" + response_method_help());
  command->add_option("--realisation", options->realisations,
                      "Further record with other phases, for --method robust (may be repeated)");
  command
      ->add_option("--segment", options->response.segment_samples,
                   "Segment length of Welch's method [samples]")
      ->check(positive_number())
      ->capture_default_str();
  command->add_option("--low", options->low_hz, "Lowest frequency of a model's diagram [Hz]")
      ->capture_default_str();
  command->add_option("--high", options->high_hz, "Highest frequency of a model's diagram [Hz]")
      ->capture_default_str();
  options->record.add_to(*command);
  add_common_options(*command, options->common);
  command->footer(
      "Examples:\n"
      "  vibrissa bode sensor.prm -o response\n"
      "  vibrissa bode bench.csv --period 2048 --column 'base_acceleration=ax[g]'\n"
      "  vibrissa bode bench.csv --method local-polynomial --response bench.uff");
  command->callback([options] { bode(*options); });
}

}  // namespace vibrissa::apps
