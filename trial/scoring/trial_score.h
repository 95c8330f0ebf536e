#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "report/figures/figure.h"
#include "report/figures/table.h"
#include "trial/classes/case_class.h"
#include "trial/scoring/trial_files.h"
#include "trial/scoring/trial_statistics.h"

namespace vibrissa::trial {

/// One case: truth and diagnosis.
struct ScoredCase {
  std::string name;
  CaseClass kind = CaseClass::none;
  std::string truth, verdict;  // truth: the correct verdict
  std::string effects{};       // names of the generator
  double size_in_limits = 0.;  // of the smallest effect; 0 without one
  int exit_status = 0;
  double probability = 0., seconds = 0.;
  double probability_of_tried = 1.;               // that any tested answer is right
  double probability_of_outside = 0.;             // of a cause outside the catalogue
  std::map<std::string, double> probabilities{};  // of all answers that are listed
  bool right = false, right_within_set = false, in_top_three = false, in_confidence_set = false;
  bool links_right = false;
  std::size_t confidence_set_size = 0;
  std::optional<double> gap_closed{}, transfer_gap_closed{};
  std::vector<double> parameter_errors{};  // divided by the stated standard deviation
  /// Does exactly one answer, the right one, remain after a further experiment? Nothing where none
  /// was made.
  std::optional<bool> resolved_as_recommended{}, resolved_by_chance{};
};

/// Scores of a trial.
struct TrialScore {
  std::vector<ScoredCase> cases;  // cases with an answer
  std::size_t unanswered = 0;
  std::map<std::string, Share> shares;    // by name of the score
  std::map<std::string, double> figures;  // medians, errors, areas
  std::vector<ReliabilityBin> reliability;
  /// Calibration of diagnosis/search/calibrated_odds.h fitted to these answers, by kind of answer,
  /// and the number of answers.
  std::map<std::string, std::pair<LogisticLine, std::size_t>> trust;
  /// Share of the wrong answers of a kind whose true cause is outside the catalogue.
  std::map<std::string, Share> unknown;
};

/// Compares the answers with the opened labels. Proven by tests/apps/trial_test.cc.
TrialScore score_trial(const TrialIndex& trial, const nlohmann::json& labels);

nlohmann::json to_json(const TrialScore& score);
report::Table case_table(const TrialScore& score);
report::Table summary_table(const TrialScore& score);
/// Wrong answers by true cause and verdict: their number, and the number expected from the stated
/// probabilities.
report::Table confusion_table(const TrialScore& score);
/// Accuracy against effect size, and reliability diagram.
std::vector<report::Figure> trial_figures(const TrialScore& score);

}  // namespace vibrissa::trial
