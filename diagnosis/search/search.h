#pragma once

#include <functional>
#include <string>
#include <vector>

#include "diagnosis/fit/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// One answer with its probability: effects of a hypothesis and calibration effects named with it.
struct Candidate {
  std::string name;     // ids joined by '+', "none"
  std::size_t fit = 0;  // in SearchResult::fits
  std::vector<std::string> calibrations;
  double log_posterior = 0.;
  double probability = 0.;
};

struct SearchResult {
  std::vector<HypothesisFit> fits;
  std::vector<Candidate> candidates;  // most probable first; probabilities are calibrated
  double odds_against_best = 0.;      // by the fits
  /// Answers that leave too much to be the cause, or all of it: what comes nearest first.
  std::vector<Candidate> refuted;
};

struct SearchOptions {
  std::size_t max_effects = 3;
  std::size_t n_threads = 2;
  std::vector<std::string> left_out = {};  // effects that are not tried
  std::function<void()> on_fit = {};       // after each fit, one at a time
};

/// Fits none, every single effect, then combinations: the best ones of a size are each joined with
/// the effects whose shape the residual resembles most. Each candidate is one hypothesis with one
/// choice of calibration effects; its prior pays for every effect named. Throws UserError where
/// none has a likelihood that is a number.
SearchResult search(const Experiment& experiment, const SearchOptions& options = {});

/// Probabilities of the candidates, the best of which comes first, from their posteriors; and the
/// odds against it.
void set_probabilities(SearchResult& result);

}  // namespace vibrissa::diagnosis
