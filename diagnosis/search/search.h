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
  std::vector<Candidate> candidates;  // most probable first, with calibrated probabilities
  double odds_against_best = 0.;      // uncalibrated, from the fits
  /// Answers that fail the residual test, the nearest one first.
  std::vector<Candidate> refuted;
};

struct SearchOptions {
  std::size_t max_effects = 3;
  std::size_t n_threads = 2;
  std::vector<std::string> left_out = {};  // effects that are not tested
  std::function<void()> on_fit = {};       // after each fit, one at a time
};

/// Fits "none", every single effect, then combinations: the best hypotheses of each size are
/// extended by the effects whose shapes the residual resembles most. Each candidate is one
/// hypothesis with one choice of named calibration effects; every named effect costs prior
/// probability. Throws UserError when no likelihood is finite.
SearchResult search(const Experiment& experiment, const SearchOptions& options = {});

/// Probabilities of the candidates (best first) from their posteriors, and the odds against the
/// best one.
void set_probabilities(SearchResult& result);

}  // namespace vibrissa::diagnosis
