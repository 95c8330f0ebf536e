#include "apps/solid/jobs/run_job.h"
#include "apps/command_line/programs.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/solid/jobs/full_order_check.h"
#include "apps/solid/jobs/recorded_inputs.h"
#include "case/inputs.h"
#include "case/rig.h"
#include "case/sensor_model.h"
#include "fem/linalg/processes.h"
#include "fem/linalg/solver_session.h"
#include "report/figures/mode_picture.h"
#include "report/figures/table.h"
#include "report/files/run_folder.h"
#include "report/modes/page_scene.h"
#include "separation/filters/bvrm_separator.h"
#include "separation/filters/fdaf.h"
#include "separation/identification/identify.h"
#include "separation/model/sampled_bvrm.h"
#include "signals/base/error.h"
#include "signals/files/record_io.h"
#include "signals/model/band_limited_simulation.h"
#include "views/records/bode_data.h"
#include "views/records/identification_report.h"
#include "views/records/separation_scores.h"
#include "views/run/mode_table.h"
#include "views/run/run_page.h"
#include "views/run/run_plots.h"
#include "views/run/run_shapes.h"

namespace vibrissa::apps {

namespace {

namespace fs = std::filesystem;

separation::Identification identify(const sensor_case::RigRecords& records,
                                    const sensor_case::Case& parameters) {
  separation::IdentifyOptions options;
  options.max_order = parameters.separation.largest_order;
  // The rig's base motion is so by construction.
  options.hold = separation::Hold::band_limited;
  const auto [fit, held_out] = separation::hold_out_last_third(records.vibration_only);
  return separation::identify_bvrm(fit, held_out, options);
}

// The best that any model of the vibration can do: the true response, driven by the noisy
// accelerometer, on the noisy moment.
std::vector<double> separate_by_true_response(const signals::ReducedModel& model,
                                              const signals::Record& record) {
  const auto response =
      signals::simulate_band_limited(model, {record.sampling_rate_hz(), record.n_samples(),
                                             record.channel(signals::channel::base_acceleration)});
  const auto measured = record.channel(signals::channel::base_moment);
  std::vector<double> wind(measured.begin(), measured.end());
  for (std::size_t i = 0; i < wind.size(); ++i) wind[i] -= response.base_moment[i];
  return wind;
}

std::vector<views::SeparatedSignal> separate(const signals::ReducedModel& model,
                                             const separation::Identification& identified,
                                             const sensor_case::RigRecords& records,
                                             const sensor_case::SeparationParameters& parameters) {
  const auto& record = records.both;
  const auto measured = record.channel(signals::channel::base_moment);
  separation::BvrmSeparator bvrm(identified.fit.model, record.sampling_rate_hz(), identified.hold);
  separation::Fdaf fdaf(parameters.fdaf);
  const auto scored = [&](const std::string& name, std::vector<double> wind) {
    return views::score(name, std::move(wind), record, records.true_wind_moment_n_m,
                        parameters.settling_s);
  };
  return {scored("nothing removed", {measured.begin(), measured.end()}),
          scored("bvrm", separation::separate_record(bvrm, record)),
          scored("fdaf", separation::separate_record(fdaf, record)),
          scored("true response", separate_by_true_response(model, record))};
}

views::BodeCurve measured_curve(const sensor_case::RigRecords& records) {
  const auto& record = records.vibration_only;
  signals::WelchOptions options;
  options.segment_samples = std::min<std::size_t>(options.segment_samples, record.n_samples() / 4);
  views::BodeCurve curve{
      "record (Welch, coherence above 0.5)", report::CurveStyle::points,
      signals::welch_response(record.channel(signals::channel::base_acceleration),
                              record.channel(signals::channel::base_moment),
                              record.sampling_rate_hz(), options)};
  // A point without coherence says nothing of the response: it is left out of the picture.
  for (std::size_t i = 0; i < curve.response.value.size(); ++i) {
    if (curve.response.coherence[i] < 0.5) curve.response.value[i] = std::nan("");
  }
  return curve;
}

report::Figure run_bode(const signals::ReducedModel& model,
                        const separation::Identification& identified,
                        const sensor_case::RigRecords& records) {
  std::vector<double> resonances;
  for (const auto& mode : model.modes) resonances.push_back(mode.frequency_hz);
  const double nyquist = 0.5 * records.both.sampling_rate_hz();
  const auto f = views::bode_frequencies(1., nyquist, resonances);
  return views::bode_figure({views::bode_curve(model, f),
                             views::bode_curve(identified.fit.model, f), measured_curve(records)});
}

signals::Record separated_record(const sensor_case::RigRecords& records,
                                 const std::vector<views::SeparatedSignal>& signals) {
  signals::Record output(records.both.sampling_rate_hz(), records.both.n_samples());
  output.set_channel("wind_moment_true_N_m", records.true_wind_moment_n_m);
  output.set_channel("vibration_moment_true_N_m", records.true_vibration_moment_n_m);
  for (const auto& signal : signals) {
    std::string name = signal.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    output.set_channel("wind_moment_" + name + "_N_m", signal.wind_moment_n_m);
  }
  return output;
}

/// What the stages of the job hand on.
struct Results {
  signals::ReducedModel model;
  sensor_case::RigRecords records;
  separation::Identification identified;
  std::vector<views::SeparatedSignal> separated;
};

Results simulate_and_separate(const signals::ReducedModel& model,
                              const sensor_case::Case& parameters,
                              const sensor_case::Inputs& inputs) {
  auto records = sensor_case::measure_on_rig(model, parameters, inputs);
  auto identified = identify(records, parameters);
  auto separated = separate(model, identified, records, parameters.separation);
  return {model, std::move(records), std::move(identified), std::move(separated)};
}

std::vector<report::Figure> run_figures(const Results& results) {
  return {run_bode(results.model, results.identified, results.records),
          views::records_figure(results.records),
          views::separation_figure(results.records, results.separated),
          views::spectra_figure(results.records, results.separated)};
}

void write_results(const report::RunFolder& folder, const fem::Sensor& sensor,
                   const Results& results, const std::vector<report::Figure>& figures) {
  folder.write_text("modes.csv", views::modes_table(sensor).to_csv());
  signals::write_reduced_model(folder.file("model.json"), results.model);
  signals::write_record(folder.file("records/vibration_only.csv"), results.records.vibration_only);
  signals::write_record(folder.file("records/wind_only.csv"), results.records.wind_only);
  signals::write_record(folder.file("records/both.csv"), results.records.both);
  signals::write_record(folder.file("records/separated.csv"),
                        separated_record(results.records, results.separated));
  separation::write_bvrm(folder.file("bvrm.json"),
                         {results.identified.fit.model, results.identified.hold});
  folder.write_text("metrics.csv", views::separation_table(results.separated).to_csv());
  for (const auto& figure : figures) report::write_figure(folder.path(), figure);
}

/// What needs no solid: of the first process. Returns what is said of it on the page.
views::RunPageParts do_signals_part(const report::RunFolder& folder, const fem::Sensor& sensor,
                                    const sensor_case::Case& parameters,
                                    const sensor_case::Inputs& inputs,
                                    const signals::ReducedModel& model, RunOutcome& outcome) {
  const Results results = simulate_and_separate(model, parameters, inputs);
  views::RunPageParts parts{.modes = views::modes_table(sensor),
                            .resonance_hz = sensor.modes()[0].frequency_hz,
                            .damping_ratio = sensor.damping_ratios()[0],
                            .calibration_note = sensor.calibration_note(),
                            .identified = results.identified,
                            .separated = results.separated,
                            .settling_s = parameters.separation.settling_s,
                            .figures = run_figures(results)};
  write_results(folder, sensor, results, parts.figures);
  outcome.separated = results.separated;
  outcome.summary["identification"] = separation::identification_json(results.identified);
  outcome.summary["separation"] = views::separation_json(results.separated);
  return parts;
}

report::RunFolder new_run_folder(const CaseOptions& chosen, const sensor_case::CaseFile& file,
                                 const sensor_case::Case& parameters, const fem::Sensor& sensor,
                                 const std::vector<std::string>& command_line) {
  auto folder = report::RunFolder::given_or_free(
      parameters.output.folder, fs::path("results") / fs::path(chosen.case_file).stem());
  folder.write_text("resolved.prm", file.resolved());
  folder.write_run(
      {command_line, parameters.records.seed, {{"mesh_sha256", sensor.mesh_sha256()}}});
  return folder;
}

void check_settling(const sensor_case::Case& parameters) {
  if (parameters.separation.settling_s >= 0.5 * parameters.records.duration_s)
    throw signals::UserError(
        "Separation/Settling time (" + report::Cell(parameters.separation.settling_s).exact() +
        " s) must be less than half of Records/Duration (" +
        report::Cell(parameters.records.duration_s).exact() +
        " s), because the scores leave it out; shorten it or lengthen the records");
}

}  // namespace

RunOutcome run_job(const CaseOptions& chosen, const std::vector<std::string>& command_line,
                   const bool quiet) {
  sensor_case::CaseFile file = chosen.load();
  const sensor_case::Case parameters = file.read();
  check_settling(parameters);
  sensor_case::check_reduced_wind(parameters);
  sensor_case::refuse_gravity(parameters, "the job's model");
  const sensor_case::Inputs inputs = sensor_case::make_inputs(parameters);
  if (!quiet && fem::is_first_process()) report_recorded_inputs(parameters);
  const fem::SolverSession session;
  const fem::Sensor sensor(parameters.sensor);

  std::optional<report::RunFolder> folder;  // of the first process
  if (fem::is_first_process())
    folder = new_run_folder(chosen, file, parameters, sensor, command_line);
  RunOutcome outcome;
  outcome.folder = fem::from_first_process(folder ? folder->path().string() : "");
  const fs::path vtk_folder = outcome.folder / "vtk";

  const auto model = sensor_case::make_reduced_model(sensor, parameters.sensor, !quiet);
  outcome.summary = views::modes_json(sensor);
  if (const auto note = sensor.calibration_note()) outcome.summary["calibration_note"] = *note;
  std::optional<views::RunPageParts> page;  // of the first process
  if (folder) page = do_signals_part(*folder, sensor, parameters, inputs, model, outcome);
  if (parameters.output.vtk) {
    const auto shapes = views::write_shapes(vtk_folder, sensor);
    if (folder) {
      page->shapes = shapes;
      for (const std::size_t drawn : {std::size_t{0}, shapes.size() - 1})
        report::write_mode_picture(folder->path(), shapes[drawn]);
    }
  }
  if (parameters.output.full_order_duration_s > 0.) {
    outcome.summary["full_order_check"] =
        check_full_order(sensor, model, parameters, inputs, vtk_folder, !quiet);
  }
  if (!folder) return outcome;
  if (parameters.output.pictures) outcome.pictures = draw_pictures(folder->path());
  report::write_page(folder->path(), views::run_page(*page), report::page_scene);
  outcome.summary["folder"] = folder->path().string();
  folder->write_json("summary.json", outcome.summary);
  return outcome;
}

}  // namespace vibrissa::apps
