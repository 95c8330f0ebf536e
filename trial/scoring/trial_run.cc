#include "trial/scoring/trial_run.h"

#include <exception>
#include <map>
#include <random>

#include "diagnosis/diagnosis.h"
#include "diagnosis/search/confidence_set.h"
#include "fem/linalg/solver_session.h"
#include "signals/base/error.h"
#include "signals/base/exit_status.h"
#include "signals/system/output_file.h"
#include "signals/system/progress.h"
#include "signals/system/stopwatch.h"
#include "trial/scoring/trial_files.h"
#include "trial/scoring/trial_queue.h"

namespace vibrissa::trial {
namespace {

namespace exit_status = signals::exit_status;

namespace fs = std::filesystem;
using nlohmann::json;

/// The diagnosis with the records of a further experiment added.
json answer_after(const std::string& experiment, const fs::path& folder, signals::Dataset real,
                  const diagnosis::UpdatedModel& simulation,
                  const diagnosis::DiagnoseOptions& settings) {
  for (signals::DatasetRecord& entry :
       signals::read_dataset(folder / "further" / experiment).records)
    real.records.push_back(std::move(entry));
  const diagnosis::Diagnosis said = diagnosis::diagnose(simulation, real, settings);
  return {{"experiment", experiment},
          {"verdict", said.verdict},
          {"probability", said.ranking.front().probability},
          {"confidence_set", said.confidence_set}};
}

/// A random experiment other than the recommended one; the same for the same case name on all
/// machines.
std::string by_chance(std::vector<std::string> experiments, const std::string& recommended,
                      const std::string& name) {
  std::erase(experiments, recommended);
  std::seed_seq seed(name.begin(), name.end());
  std::mt19937 random(seed);
  return experiments.empty() ? "" : experiments[random() % experiments.size()];
}

/// The diagnoses after the recommended experiment and after a random other one.
json answers_after(const TrialIndex& trial, const TrialEntry& entry, const signals::Dataset& real,
                   const diagnosis::UpdatedModel& simulation,
                   const diagnosis::DiagnoseOptions& settings, const std::string& recommended) {
  const auto after = [&](const std::string& experiment) -> json {
    try {
      return answer_after(experiment, trial.folder / entry.name, real, simulation, settings);
    } catch (const std::exception& error) {
      return {{"experiment", experiment}, {"message", error.what()}};
    }
  };
  json out{{"recommended", after(recommended)}};
  const std::string other = by_chance(entry.further_experiments, recommended, entry.name);
  if (!other.empty()) out["by_chance"] = after(other);
  return out;
}

/// Simulations that several cases share are read once.
class Simulations {
 public:
  explicit Simulations(const TrialRunOptions& options) : options_(options) {}
  const TrialSimulation& of(const TrialEntry& entry) {
    const auto there = read_.find(entry.simulation);
    if (there != read_.end()) return there->second;
    return read_.emplace(entry.simulation, options_.read_simulation(entry.simulation))
        .first->second;
  }

 private:
  const TrialRunOptions& options_;
  std::map<fs::path, TrialSimulation> read_;
};

diagnosis::DiagnoseOptions settings_of(const TrialEntry& entry, const TrialRunOptions& options) {
  diagnosis::DiagnoseOptions settings;
  settings.search = {.max_effects = options.max_effects,
                     .n_threads = options.n_threads,
                     .left_out = entry.left_out};
  settings.simulation_accuracy = options.simulation_accuracy.value_or(
      entry.simulation_accuracy.value_or(diagnosis::usual_simulation_accuracy));
  settings.possible_experiments = entry.further_experiments;
  return settings;
}

json answer(const TrialIndex& trial, const TrialEntry& entry, Simulations& simulations,
            const TrialRunOptions& options) {
  diagnosis::DiagnoseOptions settings = settings_of(entry, options);
  json out{{"schema", "vibrissa-trial-answer-1"}};
  const auto failed = [&](int status, const std::string& message) {
    out["exit_status"] = status;
    out["message"] = message;
    return out;
  };
  signals::Stopwatch watch;
  try {
    const auto real = signals::read_dataset(entry.real);
    const TrialSimulation& simulation = simulations.of(entry);
    settings.simulated_rate_hz = simulation.sampling_rate_hz;
    const diagnosis::Diagnosis said = diagnosis::diagnose(simulation.model, real, settings);
    out["diagnosis"] = json::parse(diagnosis::diagnosis_json(said));
    out["exit_status"] = 0;
    out["seconds"] = watch.elapsed_s();
    if (options.further && diagnosis::n_known(said.confidence_set) > 1 && said.next.name != "none")
      out.update(answers_after(trial, entry, real, simulation.model, settings, said.next.name));
  } catch (const diagnosis::TooLittleData& error) {
    return failed(exit_status::too_little_data, error.what());
  } catch (const signals::UserError& error) {
    return failed(exit_status::bad_input, error.what());
  } catch (const std::bad_alloc&) {
    return failed(exit_status::no_resource, "not enough memory");
  } catch (const std::exception& error) {
    return failed(exit_status::fault, error.what());
  }
  return out;
}

}  // namespace

TrialRunSummary run_trial(const fs::path& folder, const TrialRunOptions& options) {
  const fem::SolverSession session;
  const TrialIndex trial = read_trial(folder);
  if (options.further && trial.further_experiments.empty())
    throw signals::UserError(folder.string() +
                             ": the trial contains no further experiments (finite-strain trials "
                             "have none); run it without --further");
  Simulations simulations(options);
  std::vector<const TrialEntry*> open;
  for (const TrialEntry& entry : trial.cases)
    if (!fs::exists(trial.answer_file(entry))) open.push_back(&entry);
  TrialRunSummary summary;
  summary.there_before = trial.cases.size() - open.size();
  // All ranks have the same list, because it is made before the first answer is written.
  TrialQueue queue;
  signals::Progress progress("sensors", open.size(), options.show_progress && queue.rank() == 0);
  std::exception_ptr failure;
  try {
    for (std::size_t i = queue.next(); i < open.size(); i = queue.next()) {
      const json said = answer(trial, *open[i], simulations, options);
      signals::write_file(trial.answer_file(*open[i]),
                          [&](std::ostream& out) { out << said.dump(1) << "\n"; });
      const int status = said["exit_status"];
      const bool is_refused =
          status == exit_status::bad_input || status == exit_status::too_little_data;
      ++(status == 0 ? summary.answered : is_refused ? summary.refused : summary.failed);
      progress.advance(static_cast<std::size_t>(queue.n_ranks()));
    }
  } catch (...) {
    // The other ranks wait for this one at the end, even if a file cannot be written.
    failure = std::current_exception();
  }
  const std::vector<unsigned long> all =
      queue.total({summary.answered, summary.refused, summary.failed});
  if (failure) std::rethrow_exception(failure);
  summary.answered = all[0];
  summary.refused = all[1];
  summary.failed = all[2];
  summary.is_first_rank = queue.rank() == 0;
  return summary;
}

}  // namespace vibrissa::trial
