#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/command_line/command.h"
#include "apps/command_line/record_options.h"
#include "apps/command_line/results.h"
#include "apps/solid/jobs/case_options.h"
#include "apps/solid/jobs/recorded_inputs.h"
#include "case/inputs.h"
#include "case/rig.h"
#include "case/sensor_model.h"
#include "diagnosis/model/updated_model.h"
#include "diagnosis/prediction/record_simulation.h"
#include "fem/linalg/processes.h"
#include "fem/linalg/solver_session.h"
#include "signals/base/error.h"
#include "signals/files/record_io.h"

namespace vibrissa::apps {

namespace {

struct SimulateOptions {
  CommonOptions common;
  CaseOptions chosen;
  std::optional<std::string> record_file, model_file, input_file;
  bool periodic = false;
};

/// The inputs of a record with the base moment that an updated model reads under them.
signals::Record updated_record(const SimulateOptions& options) {
  if (!options.chosen.is_plain() || options.model_file)
    throw signals::UserError(
        "an updated model is simulated as it is, under --inputs: leave out --write-model and the "
        "options that change a case file");
  if (!options.input_file)
    throw signals::UserError("--inputs: an updated model needs a record with its inputs");
  signals::Record record = signals::read_record(*options.input_file);
  record.set_channel(
      signals::channel::base_moment,
      diagnosis::simulate_moment(
          diagnosis::read_updated_model(options.chosen.case_file), record,
          options.periodic ? diagnosis::Start::periodic : diagnosis::Start::settled));
  return record;
}

FileNames recordings_of(const sensor_case::Case& parameters) {
  return {parameters.base.recorded.file.string(), parameters.wind_record.file.string()};
}

void write(const SimulateOptions& options, const signals::Record& record,
           const std::string& solver) {
  const std::string file = given_or_result(options.record_file, "simulate", "record.csv");
  signals::write_record(file, record);
  if (options.common.json) {
    nlohmann::json document = written_record_json(file, record);
    document["solver"] = solver;
    print_json(document);
  } else if (!options.common.quiet) {
    std::cout << written_record_text(file, record);
  }
}

void simulate(const SimulateOptions& options) {
  const FileNames outputs = {options.record_file, options.model_file};
  refuse_overwriting({options.chosen.case_file, options.input_file}, outputs);
  if (diagnosis::is_updated_model(options.chosen.case_file)) {
    if (!fem::is_first_process()) return;
    const signals::Record record = updated_record(options);
    write(options, record, "updated model");
    return;
  }
  if (options.input_file)
    throw signals::UserError(
        "--inputs is for an updated model; a case file names its inputs itself");
  if (options.periodic)
    throw signals::UserError("--periodic belongs to --inputs of an updated model");
  CaseOptions chosen = options.chosen;
  if (options.model_file) chosen.use = sensor_case::CaseUse::record_and_model;
  sensor_case::Case parameters = chosen.load().read();
  // Only the model file holds them.
  if (!options.model_file) parameters.sensor.model.sensitivities = false;
  refuse_overwriting(recordings_of(parameters), outputs);
  sensor_case::check_reduced_wind(parameters);
  sensor_case::refuse_gravity(parameters, "the reduced model");
  const sensor_case::Inputs inputs = sensor_case::make_inputs(parameters);
  if (!options.common.quiet && fem::is_first_process()) report_recorded_inputs(parameters);
  const fem::SolverSession session;
  const fem::Sensor sensor(parameters.sensor);
  const auto model =
      sensor_case::make_reduced_model(sensor, parameters.sensor, !options.common.quiet);
  const signals::Record record = sensor_case::measure_on_rig(model, parameters, inputs).both;
  if (!fem::is_first_process()) return;
  if (options.model_file) signals::write_reduced_model(*options.model_file, model);
  write(options, record, "reduced");
}

}  // namespace

void add_simulate_command(CLI::App& app) {
  const auto options = std::make_shared<SimulateOptions>();
  auto* command = app.add_subcommand(
      "simulate", "Simulates a record: base moment under base vibration and wind, with noise");
  options->chosen.add_to(*command, sensor_case::CaseUse::record);
  command->get_option("case")->description(
      "Case file (.prm), or updated_model.json of a diagnosis together with --inputs");
  command->add_option("-o,--output,--out,--record", options->record_file,
                      "File for the record (default: results/simulate/record.csv, or "
                      "results/simulate-2/, ... if it exists)");
  command->add_option("--write-model", options->model_file, "Also writes the reduced model (JSON)");
  command->add_option("--inputs", options->input_file,
                      "For updated_model.json: record with the base acceleration and wind speed "
                      "that act on it, in SI; no noise is added");
  command->add_flag("--periodic", options->periodic,
                    "Says that the record of --inputs is a whole number of periods in steady "
                    "state, so that the simulation starts without a transient");
  add_common_options(*command, options->common);
  command->footer(
      "Examples:\n"
      "  vibrissa simulate sensor.prm -o simulated.csv --write-model model.json\n"
      "  vibrissa simulate sensor.prm --set 'Materials/Silicone/c1=2.4e5' -o softer.csv\n"
      "  vibrissa simulate diagnosis/updated_model.json --inputs bench.csv -o updated.csv");
  command->callback([options] { simulate(*options); });
}

}  // namespace vibrissa::apps
