#pragma once

#include <cstddef>
#include <filesystem>

#include "diagnosis/search/search.h"

namespace vibrissa::trial {

struct TrialRunOptions {
  std::size_t max_effects = diagnosis::SearchOptions{}.max_effects;
  std::size_t n_threads = 2;  // of each rank
  /// Where more than one known answer is left, the recommended experiment is done, and one by
  /// chance.
  bool further = false;
  bool show_progress = true;
};

struct TrialRunSummary {
  std::size_t answered = 0, refused = 0, failed = 0, there_before = 0;
  bool is_first_rank = true;  // who says so
};

/// Diagnoses every case of a trial that has no answer yet, all ranks from one queue, and leaves
/// caseNNNNN/answer.json ("vibrissa-trial-answer-1": exit_status, seconds, diagnosis or message;
/// after further experiments "recommended" and "by_chance", each with experiment, verdict,
/// probability and confidence_set).
/// The labels stay sealed: the key is not here. A case that fails is written down and does not stop
/// the others. Gives what all ranks did together.
TrialRunSummary run_trial(const std::filesystem::path& folder, const TrialRunOptions& options);

}  // namespace vibrissa::trial
