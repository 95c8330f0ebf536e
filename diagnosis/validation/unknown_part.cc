#include "diagnosis/validation/named_answers.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "diagnosis/validation/held_out.h"

namespace vibrissa::diagnosis {
namespace {

/// Terms for what a fit leaves; nothing where a random effect explains it, nor, in an answer that
/// is not outside the catalogue, where noise or the usual error of a simulation does, or where it
/// is too small a share of the gap.
std::optional<UnknownCause> left_by(const HypothesisFit& fit, const Experiment& experiment,
                                    const Experiment& scored, const bool is_outside,
                                    const std::size_t n_threads) {
  const HeldOutScore score = score_held_out(experiment, scored, fit, {.n_resamples = 0});
  const auto power = [](const double relative_rms) { return relative_rms * relative_rms; };
  const double noise = power(score.overall.noise_floor),
               gap = power(score.overall.nrmse_before) - noise,
               left = power(score.overall.nrmse_after) - noise,
               least = is_outside ? 0.
                                  : std::max({power_without_cause(experiment.simulation_accuracy),
                                              noise, least_share * gap});
  if (!score.not_predictable.empty() || !(left > least)) return std::nullopt;
  return describe_unknown(experiment, scored, fit, noise / (noise + left), n_threads);
}

}  // namespace

std::optional<UnknownCause> unknown_part(const SearchResult& result, const Experiment& experiment,
                                         const Experiment& scored, const std::size_t n_threads) {
  // Terms are integrated in time.
  const auto is_in_time = std::not_fn(&PreparedRecord::is_response);
  if (!std::ranges::all_of(experiment.records, is_in_time) ||
      !std::ranges::all_of(scored.records, is_in_time))
    return std::nullopt;
  const Candidate& best = result.candidates.front();
  const HypothesisFit& answer = result.fits[best.fit];
  const HypothesisFit& none = *std::ranges::find_if(
      result.fits, [](const HypothesisFit& fit) { return fit.hypothesis.name() == "none"; });
  if (best.name == outside_catalogue) return left_by(none, experiment, scored, true, n_threads);
  auto beside = left_by(answer, experiment, scored, false, n_threads);
  if (!beside || answer.hypothesis.effects().empty()) return beside;
  auto alone = left_by(none, experiment, scored, false, n_threads);
  const double usual = std::pow(experiment.simulation_accuracy, 2);
  // More terms, or what the catalogue has, would be no simpler than the answer.
  if (!alone || alone->terms.size() != 1 || !alone->terms.front().like.empty() ||
      alone->left > std::max(beside->left, usual))
    return beside;
  alone->replaces_effects = true;
  return alone;
}

void prefer_outside(SearchResult& result) {
  std::vector<Candidate>& candidates = result.candidates;
  const auto outside = std::ranges::find(candidates, outside_catalogue, &Candidate::name);
  if (outside == candidates.end()) return;
  result.nearest_known = candidates.front().fit;
  std::swap(outside->probability, candidates.front().probability);
  std::swap(outside->log_posterior, candidates.front().log_posterior);
  std::iter_swap(outside, candidates.begin());
}

}  // namespace vibrissa::diagnosis
