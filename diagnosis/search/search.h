#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/fit/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// One answer with its probability: effects of a hypothesis and, after name_calibrations()
/// (attribution.h), the calibration effects that close a part of the gap.
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
  /// The most probable fit with a known effect, after name_answers() (named_answers.h).
  std::optional<std::size_t> nearest_known{};
  bool is_complete = true;  // false: the time limit ended the search
};

struct SearchOptions {
  std::size_t max_effects = 3;
  std::size_t n_threads = 2;
  std::vector<std::string> left_out = {};  // effects that are not tested
  std::function<void()> on_fit = {};       // after each fit, one at a time
  /// No further fit begins after this time [s].
  double time_limit_s = std::numeric_limits<double>::infinity();
  /// Sees the answers with one effect; true ends the search.
  std::function<bool(const SearchResult&)> ends_after_singles = {};
};

/// Fits "none" (calibration parameters alone), an unknown cause, every effect whose shape the
/// residual resembles, then combinations: the best hypotheses of each size are extended by the
/// effects that resemble what they leave. Each effect costs prior probability. Throws UserError
/// when no likelihood is finite.
SearchResult search(const Experiment& experiment, const SearchOptions& options = {});

/// Probabilities of the candidates (best first) from their posteriors, and the odds against the
/// best one.
void set_probabilities(SearchResult& result);

}  // namespace vibrissa::diagnosis
