#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/bode_data.h"
#include "apps/case_file.h"
#include "apps/command.h"
#include "apps/record_options.h"
#include "fem/reduction.h"
#include "fem/solver_session.h"
#include "report/pictures.h"
#include "signals/error.h"
#include "signals/output_file.h"

namespace vibrissa::apps {

namespace {

struct BodeOptions {
  CommonOptions common;
  RecordOptions record;
  std::string input;
  std::optional<std::string> folder;
  std::size_t period_samples = 0;
  std::size_t segment_samples = 2048;
  double low_hz = 1., high_hz = 200.;
};

std::vector<double> resonances(const signals::ReducedModel& model) {
  std::vector<double> f;
  for (const auto& mode : model.modes) f.push_back(mode.frequency_hz);
  return f;
}

BodeCurve of_model(const signals::ReducedModel& model, const BodeOptions& options) {
  return bode_curve(model, bode_frequencies(options.low_hz, options.high_hz, resonances(model)));
}

BodeCurve of_case(const BodeOptions& options) {
  const Case parameters = CaseFile(options.input).read();
  const fem::SolverSession session;
  auto model = fem::reduce(fem::Sensor(parameters.sensor));
  model.name = "simulated sensor";
  return of_model(model, options);
}

BodeCurve of_record(const BodeOptions& options) {
  const signals::Record record = options.record.read(options.input);
  const auto a = record.channel(signals::channel::base_acceleration);
  const auto m = record.channel(signals::channel::base_moment);
  if (options.period_samples > 0) {
    return {"whole periods", report::CurveStyle::points,
            signals::periodic_response(a, m, record.sampling_rate_hz(), options.period_samples)};
  }
  return {"Welch", report::CurveStyle::line,
          signals::welch_response(a, m, record.sampling_rate_hz(), {options.segment_samples})};
}

BodeCurve make_curve(const BodeOptions& options) {
  if (!(options.low_hz > 0. && options.low_hz < options.high_hz)) {
    throw signals::UserError("--low must be positive and below --high");
  }
  const auto extension = std::filesystem::path(options.input).extension();
  if (extension == ".prm") return of_case(options);
  if (extension == ".json") return of_model(signals::read_reduced_model(options.input), options);
  return of_record(options);
}

nlohmann::json response_json(const signals::FrequencyResponse& response) {
  nlohmann::json points = nlohmann::json::array();
  for (std::size_t i = 0; i < response.frequency_hz.size(); ++i) {
    nlohmann::json point{{"frequency_hz", response.frequency_hz[i]},
                         {"real", response.value[i].real()},
                         {"imaginary", response.value[i].imag()}};
    if (!response.coherence.empty()) point["coherence"] = response.coherence[i];
    if (!response.standard_deviation.empty()) {
      point["standard_deviation"] = response.standard_deviation[i];
    }
    points.push_back(point);
  }
  return {{"unit", "N m s^2/m"}, {"convention", "exp(+j w t)"}, {"points", points}};
}

void bode(const BodeOptions& options) {
  const BodeCurve curve = make_curve(options);
  if (options.folder) {
    signals::make_new_folder(*options.folder);
    report::write_figure(*options.folder, bode_figure({curve}));
    const auto pictures = report::draw_pictures(*options.folder);
    if (!options.common.json) std::cout << pictures.message << "\n";
  }
  if (options.common.json) {
    print_json(response_json(curve.response));
    return;
  }
  if (options.folder) return;
  std::cout << "frequency_hz,magnitude_n_m_s2_per_m,phase_deg\n";
  const auto figure = bode_figure({curve});
  for (std::size_t i = 0; i < curve.response.frequency_hz.size(); ++i) {
    std::cout << curve.response.frequency_hz[i] << "," << figure.panels[0].curves[0].y[i] << ","
              << figure.panels[1].curves[0].y[i] << "\n";
  }
}

}  // namespace

void add_bode_command(CLI::App& app) {
  const auto options = std::make_shared<BodeOptions>();
  auto* command = app.add_subcommand(
      "bode", "Frequency response base acceleration -> base moment of a case, a model or a record");
  command
      ->add_option("input", options->input,
                   "Case file (.prm), reduced model (.json) or record (.csv)")
      ->required();
  command->add_option("-o,--output", options->folder, "New folder for figure, picture and CSV");
  command->add_option(
      "--period", options->period_samples,
      "Period of a periodic record [samples]: averages of whole periods, no leakage");
  command
      ->add_option("--segment", options->segment_samples,
                   "Segment length for records that are not periodic [samples]")
      ->capture_default_str();
  command->add_option("--low", options->low_hz, "Lowest frequency of a model's diagram [Hz]")
      ->capture_default_str();
  command->add_option("--high", options->high_hz, "Highest frequency of a model's diagram [Hz]")
      ->capture_default_str();
  options->record.add_to(*command);
  add_common_options(*command, options->common);
  command->callback([options] { bode(*options); });
}

}  // namespace vibrissa::apps
