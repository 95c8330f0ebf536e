#include "apps/trial_run.h"

#include <chrono>

#include "apps/trial_files.h"
#include "apps/trial_queue.h"
#include "diagnosis/diagnosis_json.h"
#include "diagnosis/nominal_identification.h"
#include "fem/solver_session.h"
#include "signals/error.h"
#include "signals/output_file.h"
#include "signals/progress.h"

namespace vibrissa::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int bad_input = 2, too_poor_data = 3, fault = 70;

json answer(const TrialIndex& trial, const TrialEntry& entry,
            const diagnosis::NominalModel& nominal, const TrialRunOptions& options) {
  diagnosis::DiagnoseOptions settings;
  settings.search = {.max_effects = options.max_effects,
                     .n_threads = options.n_threads,
                     .left_out = entry.left_out};
  json out{{"schema", "vibrissa-trial-answer-1"}};
  const auto failed = [&](int status, const std::string& message) {
    out["exit_status"] = status;
    out["message"] = message;
    return out;
  };
  const auto start = std::chrono::steady_clock::now();
  try {
    const auto real = signals::read_dataset(trial.folder / entry.name / "real");
    out["diagnosis"] =
        json::parse(diagnosis::diagnosis_json(diagnosis::diagnose(nominal, real, settings)));
    out["exit_status"] = 0;
  } catch (const diagnosis::TooPoorData& error) {
    return failed(too_poor_data, error.what());
  } catch (const signals::UserError& error) {
    return failed(bad_input, error.what());
  } catch (const std::exception& error) {
    return failed(fault, error.what());
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  out["seconds"] = taken.count();
  return out;
}

}  // namespace

TrialRunSummary run_trial(const fs::path& folder, const TrialRunOptions& options) {
  const fem::SolverSession session;
  const TrialIndex trial = read_trial(folder);
  const diagnosis::NominalModel nominal =
      diagnosis::identify_nominal(signals::read_dataset(folder / "sim"));
  std::vector<const TrialEntry*> open;
  for (const TrialEntry& entry : trial.cases)
    if (!fs::exists(trial.answer_file(entry))) open.push_back(&entry);
  TrialRunSummary summary;
  summary.there_before = trial.cases.size() - open.size();
  // Every rank has made the same list before the first answer is written.
  TrialQueue queue;
  signals::Progress progress("sensors", open.size(), options.show_progress && queue.rank() == 0);
  for (std::size_t i = queue.next(); i < open.size(); i = queue.next()) {
    const json said = answer(trial, *open[i], nominal, options);
    signals::write_file(trial.answer_file(*open[i]),
                        [&](std::ostream& out) { out << said.dump(1) << "\n"; });
    const int status = said["exit_status"];
    ++(status == 0 ? summary.answered : status == fault ? summary.failed : summary.refused);
    progress.advance(static_cast<std::size_t>(queue.n_ranks()));
  }
  queue.barrier();
  return summary;
}

}  // namespace vibrissa::apps
