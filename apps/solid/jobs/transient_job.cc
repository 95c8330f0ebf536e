#include "apps/solid/jobs/transient_job.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <iostream>

#include "apps/solid/jobs/recorded_inputs.h"
#include "case/case_file.h"
#include "case/inputs.h"
#include "fem/linalg/processes.h"
#include "fem/linalg/solver_session.h"
#include "fem/motion/checkpoint.h"
#include "fem/motion/linear_transient.h"
#include "fem/motion/nonlinear_transient.h"
#include "fem/sensor/vtk_output.h"
#include "report/figures/table.h"
#include "report/files/run_folder.h"
#include "report/text/file_name.h"
#include "report/text/json_file.h"
#include "signals/base/error.h"
#include "signals/base/revision.h"
#include "signals/files/record_io.h"
#include "signals/system/interruption.h"
#include "signals/system/output_file.h"
#include "signals/system/progress.h"
#include "signals/system/sha256.h"
#include "signals/system/stopwatch.h"
#include "views/run/mode_table.h"

namespace vibrissa::apps {

namespace {

namespace fs = std::filesystem;
constexpr const char* checkpoint_name = "checkpoint.h5";

std::string sha256_of(const sensor_case::Inputs& inputs) {
  signals::Sha256 digest;
  for (const auto* values : {&inputs.base_acceleration_m_s2, &inputs.wind_speed_m_s})
    digest.add(values->data(), values->size() * sizeof(double));
  return digest.hex();
}

/// Processes stop and write together, whichever was asked to.
bool any_process(const bool here) {
  return dealii::Utilities::MPI::max(here ? 1 : 0, MPI_COMM_WORLD) == 1;
}

/// A run folder with the run that belongs to it.
class Job {
 public:
  Job(const fs::path& folder, const sensor_case::CaseFile& file,
      const sensor_case::Case& parameters, const sensor_case::Inputs& inputs,
      const fem::Sensor& sensor)
      : folder_(folder),
        parameters_(parameters),
        inputs_(inputs),
        sensor_(sensor),
        owner_{file.resolved(),
               {{"mesh", sensor.mesh_sha256()}, {"base motion or wind", sha256_of(inputs)}},
               signals::program_revision()},
        run_(driven(), parameters.records.n_samples(), sensor.parameters().model.axial_direction(),
             true) {}

  /// Puts the run where the folder's checkpoint is, if it has one.
  void resume() {
    if (!fs::exists(checkpoint())) return;
    const auto revision = fem::read_checkpoint(checkpoint(), owner_, run_);
    if (revision != owner_.program_revision)
      std::cerr << "vibrissa: the checkpoint was written by revision " << revision
                << " of the program, this is " << owner_.program_revision
                << ": results may differ in their last digits\n";
  }

  /// False when it was interrupted; the checkpoint is then where it stopped.
  bool go(const bool show_progress) {
    const signals::Interruption interruption;
    signals::Progress progress("full-order solid", run_.n_samples(), show_progress);
    progress.advance(run_.n_done());
    if (run_.n_done() == 1) write_frame();
    signals::Stopwatch since_written;
    while (!run_.is_done()) {
      run_.advance();
      write_frame();
      progress.advance();
      if (run_.is_done()) break;
      const bool stops = any_process(interruption.is_requested());
      if (stops || any_process(is_checkpoint_due(since_written))) {
        fem::write_checkpoint(checkpoint(), run_, owner_);
        since_written.restart();
      }
      if (stops) return false;
    }
    return true;
  }

  nlohmann::json finish() const {
    const auto summary = summarise();
    if (!fem::is_first_process()) return summary;
    write_pvd();
    signals::write_record(folder_ / "record.csv", record());
    if (!run_.output().energy.empty()) write_energy();
    if (parameters_.transient.adaptive) write_substeps();
    report::write_json(folder_ / "summary.json", summary);
    fs::remove(checkpoint());
    return summary;
  }

 private:
  fs::path checkpoint() const { return folder_ / checkpoint_name; }

  std::unique_ptr<fem::DrivenSensor> driven() const {
    const auto& solid = parameters_.transient;
    const fem::TransientInput input{parameters_.records.sampling_rate_hz,
                                    parameters_.records.n_samples(),
                                    inputs_.base_acceleration_m_s2,
                                    {},
                                    inputs_.wind_speed_m_s,
                                    inputs_.base_velocity_m_s};
    if (solid.strain == sensor_case::Strain::small)
      return fem::drive_linear(sensor_, input, {solid.spectral_radius, solid.substeps, true});
    return fem::drive_nonlinear(sensor_, input,
                                {solid.spectral_radius, solid.substeps, true, solid.gravity_m_s2,
                                 solid.newton, solid.adaptive});
  }

  bool is_checkpoint_due(signals::Stopwatch& since_written) const {
    const auto& solid = parameters_.transient;
    if (solid.checkpoint_samples > 0 && (run_.n_done() - 1) % solid.checkpoint_samples == 0)
      return true;
    return solid.checkpoint_minutes > 0. &&
           since_written.elapsed_s() > 60. * solid.checkpoint_minutes;
  }

  static std::string frame_name(const std::size_t frame, const char* const extension) {
    return "transient_" + std::to_string(frame) + extension;
  }

  void write_frame() const {
    const std::size_t every = parameters_.transient.vtk_samples, sample = run_.n_done() - 1;
    if (every == 0 || sample % every != 0) return;
    report::make_folder(folder_ / "vtk");
    fem::write_vtu(folder_ / "vtk" / frame_name(sample / every, ".vtu"), sensor_,
                   run_.sensor().state().displacement, time_s(sample));
  }

  void write_pvd() const {
    const std::size_t every = parameters_.transient.vtk_samples;
    if (every == 0) return;
    std::vector<double> times;
    std::vector<std::string> names;
    for (std::size_t sample = 0; sample < run_.n_samples(); sample += every) {
      times.push_back(time_s(sample));
      names.push_back(frame_name(sample / every, fem::n_processes() == 1 ? ".vtu" : ".pvtu"));
    }
    fem::write_pvd(folder_ / "vtk" / "transient.pvd", times, names);
  }

  double time_s(const std::size_t sample) const {
    return static_cast<double>(sample) / parameters_.records.sampling_rate_hz;
  }

  signals::Record record() const {
    signals::Record record(parameters_.records.sampling_rate_hz, run_.n_samples());
    if (!inputs_.base_acceleration_m_s2.empty())
      record.set_channel(signals::channel::base_acceleration, inputs_.base_acceleration_m_s2);
    if (!inputs_.wind_speed_m_s.empty())
      record.set_channel(signals::channel::wind_speed, inputs_.wind_speed_m_s);
    record.set_channel(signals::channel::base_moment, run_.output().base_moment);
    record.set_channel(signals::channel::cross_moment, run_.output().cross_moment);
    return record;
  }

  void write_energy() const {
    report::Table table({{"time", "s"},
                         {"kinetic", "J"},
                         {"stored", "J"},
                         {"dissipated", "J"},
                         {"numerical", "J"},
                         {"work", "J"},
                         {"error", "J"}});
    const auto& energy = run_.output().energy;
    for (std::size_t i = 0; i < energy.size(); ++i) {
      const auto& e = energy[i];
      table.add_row({time_s(i), e.kinetic_j, e.stored_j, e.dissipated_j, e.numerical_j, e.work_j,
                     e.error_j(energy.front())});
    }
    signals::write_file(folder_ / "energy.csv", [&](std::ostream& out) { out << table.to_csv(); });
  }

  void write_substeps() const {
    report::Table table({{"time", "s"}, {"substeps", ""}, {"rejected_tries", ""}, {"error", ""}});
    const auto& intervals = run_.output().intervals;
    for (std::size_t i = 0; i < intervals.size(); ++i)
      table.add_row(
          {time_s(i), intervals[i].substeps, intervals[i].n_rejected, intervals[i].error});
    signals::write_file(folder_ / "substeps.csv",
                        [&](std::ostream& out) { out << table.to_csv(); });
  }

  nlohmann::json substep_summary() const {
    const auto summary =
        fem::summarise(run_.output().intervals, parameters_.transient.adaptive->tolerance);
    return {{"smallest", summary.smallest},
            {"largest", summary.largest},
            {"mean", summary.mean},
            {"rejected_intervals", summary.n_rejected},
            {"intervals_over_tolerance", summary.n_over_tolerance}};
  }

  nlohmann::json summarise() const {
    const auto& output = run_.output();
    double peak = 0., work = 0., error = 0.;
    for (const double moment : output.base_moment) peak = std::max(peak, std::abs(moment));
    for (const auto& e : output.energy) {
      work = std::max(work, std::abs(e.work_j));
      error = std::max(error, std::abs(e.error_j(output.energy.front())));
    }
    nlohmann::json summary{
        {"samples", run_.n_samples()},
        {"sampling_rate_hz", parameters_.records.sampling_rate_hz},
        {"strain", parameters_.transient.strain == sensor_case::Strain::small ? "small" : "finite"},
        {"unknowns", sensor_.space().n_dofs()},
        {"steps", output.count.n_steps},
        {"iterations", output.count.n_iterations},
        {"factorisations", output.count.n_factorisations},
        {"largest_base_moment_n_m", peak},
        {"two_moment_routes_relative_difference", output.largest_route_difference()}};
    if (parameters_.transient.adaptive) summary["substeps"] = substep_summary();
    if (work > 0.) summary["energy_error_over_largest_work"] = error / work;
    return summary;
  }

  fs::path folder_;
  const sensor_case::Case& parameters_;
  const sensor_case::Inputs& inputs_;
  const fem::Sensor& sensor_;
  fem::CheckpointOwner owner_;
  fem::TransientRun run_;
};

TransientOutcome go_on(Job& job, const fs::path& folder, const bool show_progress) {
  TransientOutcome outcome{folder, job.go(show_progress), {}};
  if (outcome.is_done) outcome.summary = job.finish();
  return outcome;
}

fs::path new_transient_folder(const CaseOptions& chosen, const sensor_case::CaseFile& file,
                              const sensor_case::Case& parameters, const fem::Sensor& sensor,
                              const std::vector<std::string>& command_line) {
  const auto folder = report::RunFolder::given_or_free(
      parameters.output.folder,
      fs::path("results") / (fs::path(chosen.case_file).stem().string() + "-transient"));
  folder.write_text("resolved.prm", file.resolved());
  folder.write_run(
      {command_line, parameters.records.seed, {{"mesh_sha256", sensor.mesh_sha256()}}});
  return folder.path();
}

}  // namespace

TransientOutcome run_transient(const CaseOptions& chosen,
                               const std::vector<std::string>& command_line,
                               const bool show_progress) {
  sensor_case::CaseFile file = chosen.load();
  const sensor_case::Case parameters = file.read();
  const sensor_case::Inputs inputs = sensor_case::make_inputs(parameters);
  if (show_progress && fem::is_first_process()) report_recorded_inputs(parameters);
  const fem::SolverSession session;
  const fem::Sensor sensor(parameters.sensor);
  const fs::path path = fem::from_first_process(
      fem::is_first_process()
          ? new_transient_folder(chosen, file, parameters, sensor, command_line).string()
          : "");
  Job job(path, file, parameters, inputs, sensor);
  return go_on(job, path, show_progress);
}

TransientOutcome resume_transient(const fs::path& folder, const bool show_progress) {
  const fs::path case_file = folder / "resolved.prm";
  if (!fs::exists(case_file))
    throw signals::UserError(folder.string() +
                             ": holds no run that can be resumed (no resolved.prm in it); name the "
                             "folder that 'vibrissa transient' made");
  if (fs::exists(folder / "summary.json"))
    throw signals::UserError(folder.string() +
                             ": this run is complete; there is nothing to resume");
  sensor_case::CaseFile file(case_file);
  const sensor_case::Case parameters = file.read();
  const sensor_case::Inputs inputs = sensor_case::make_inputs(parameters);
  const fem::SolverSession session;
  if (fem::is_first_process()) signals::remove_unfinished_files(folder);
  const fem::Sensor sensor(parameters.sensor);
  Job job(folder, file, parameters, inputs, sensor);
  job.resume();
  return go_on(job, folder, show_progress);
}

}  // namespace vibrissa::apps
