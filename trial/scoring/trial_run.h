#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>

#include "diagnosis/model/updated_model.h"
#include "diagnosis/search/search.h"

namespace vibrissa::trial {

/// A simulation as "diagnose" reads it.
struct TrialSimulation {
  diagnosis::UpdatedModel model{};
  double sampling_rate_hz = 0.;  // 0: a model
};

struct TrialRunOptions {
  std::size_t max_effects = diagnosis::SearchOptions{}.max_effects;
  std::size_t n_threads = 2;  // per rank
  /// For all cases; nothing: the one that is stated with a case, otherwise the usual one.
  std::optional<double> simulation_accuracy{};
  /// When more than one known answer remains, add the recommended experiment, and a random one.
  bool further = false;
  bool show_progress = true;
  /// Reads records or a case file (.prm).
  std::function<TrialSimulation(const std::filesystem::path&)> read_simulation{};
};

struct TrialRunSummary {
  std::size_t answered = 0, refused = 0, failed = 0, there_before = 0;
  bool is_first_rank = true;  // prints the summary
};

/// Diagnoses every case of a trial that has no answer yet (all ranks take cases from one queue) and
/// writes caseNNNNN/answer.json ("vibrissa-trial-answer-1": exit_status, seconds, diagnosis or
/// message; after further experiments "recommended" and "by_chance", each with experiment, verdict,
/// probability and confidence_set).
/// Each case is diagnosed with its own simulation and the accuracy that is stated with it. The
/// labels stay sealed, because the key is not read. A case that fails gets its exit status and
/// message as answer and does not stop the others. Returns the counts of all ranks together.
TrialRunSummary run_trial(const std::filesystem::path& folder, const TrialRunOptions& options);

}  // namespace vibrissa::trial
