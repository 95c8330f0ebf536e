#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "report/figures/figure.h"
#include "report/figures/table.h"
#include "trial/scoring/trial_files.h"
#include "trial/scoring/trial_statistics.h"

namespace vibrissa::trial {

/// One case: what was there and what was said.
struct ScoredCase {
  std::string name, kind, truth, verdict;  // truth: as a diagnosis would name it
  std::string effects{};                   // what the generator calls them
  double size_in_limits = 0.;              // of the smallest effect; 0 without one
  int exit_status = 0;
  double probability = 0., seconds = 0.;
  double probability_of_tried = 1.;               // of any answer that was tried
  double probability_of_outside = 0.;             // of no known effect
  std::map<std::string, double> probabilities{};  // of all answers that are listed
  bool right = false, right_within_set = false, in_top_three = false, in_confidence_set = false;
  bool links_right = false;
  std::size_t confidence_set_size = 0;
  std::optional<double> gap_closed{}, transfer_gap_closed{};
  std::vector<double> parameter_errors{};  // over the deviation that was said
  /// Is one answer left, and right, after a further experiment? Nothing where none was done.
  std::optional<bool> resolved_as_recommended{}, resolved_by_chance{};
};

/// What a trial shows; each share with its exact interval.
struct TrialScore {
  std::vector<ScoredCase> cases;  // those with an answer
  std::size_t unanswered = 0;
  std::map<std::string, Share> shares;    // by what is counted
  std::map<std::string, double> figures;  // medians, errors, areas
  std::vector<ReliabilityBin> reliability;
  /// What diagnosis/search/calibrated_odds.h would learn from these answers, by their kind, and
  /// their number.
  std::map<std::string, std::pair<LogisticLine, std::size_t>> trust;
  /// And of the wrong ones of a kind, how often no known effect stood behind them.
  std::map<std::string, Share> unknown;
};

/// Compares answers with opened labels. Proven by tests/apps/trial_test.cc.
TrialScore score_trial(const TrialIndex& trial, const nlohmann::json& labels);

nlohmann::json to_json(const TrialScore& score);
report::Table case_table(const TrialScore& score);
report::Table summary_table(const TrialScore& score);
/// Truth against verdict, of wrong answers: how many there were, and how many the answers with that
/// verdict said that they expect.
report::Table confusion_table(const TrialScore& score);
/// Accuracy against size, and said against right.
std::vector<report::Figure> trial_figures(const TrialScore& score);

}  // namespace vibrissa::trial
