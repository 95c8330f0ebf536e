#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "trial/scoring/scored_case.h"
#include "trial/scoring/trial_files.h"
#include "trial/scoring/trial_statistics.h"

namespace vibrissa::trial {

/// Scores of some cases.
struct Scores {
  std::map<std::string, Share> shares;    // by name of the score
  std::map<std::string, double> figures;  // medians, errors, areas
};

/// Scores of a trial.
struct TrialScore {
  std::vector<ScoredCase> cases;  // cases with an answer
  std::size_t unanswered = 0;
  std::map<std::string, Share> shares;    // by name of the score
  std::map<std::string, double> figures;  // medians, errors, areas
  /// Of the cases of each class of circumstances: "set: base_only", "distance: exact", ...; empty
  /// for a trial of complete records.
  std::vector<std::pair<std::string, Scores>> classes;
  std::vector<ReliabilityBin> reliability;
  /// Calibration of diagnosis/search/calibrated_odds.h fitted to these answers, by kind of answer,
  /// and the number of answers.
  std::map<std::string, std::pair<LogisticLine, std::size_t>> trust;
  /// Share of the wrong answers of a kind whose true cause is outside the catalogue.
  std::map<std::string, Share> unknown;
};

/// Compares the answers with the opened labels. Proven by tests/apps/trial_test.cc.
TrialScore score_trial(const TrialIndex& trial, const nlohmann::json& labels);

}  // namespace vibrissa::trial
