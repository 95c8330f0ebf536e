#include "diagnosis/validation/shares.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "diagnosis/validation/held_out.h"

namespace vibrissa::diagnosis {
namespace {

double factorial(std::size_t n) {
  return std::tgamma(static_cast<double>(n) + 1.);
}

HypothesisFit fit_of(const Experiment& experiment, const SearchResult& result,
                     const Hypothesis& hypothesis) {
  const auto found = std::find_if(
      result.fits.begin(), result.fits.end(),
      [&](const HypothesisFit& fit) { return fit.hypothesis.name() == hypothesis.name(); });
  return found != result.fits.end() ? *found : fit_hypothesis(experiment, hypothesis);
}

}  // namespace

std::vector<double> shapley_values(const std::size_t n,
                                   const std::function<double(std::size_t)>& worth) {
  const std::size_t n_sets = std::size_t{1} << n;
  std::vector<double> worths(n_sets), values(n, 0.);
  for (std::size_t set = 0; set < n_sets; ++set) worths[set] = worth(set);
  for (std::size_t set = 0; set < n_sets; ++set) {
    const auto size = static_cast<std::size_t>(std::popcount(set));
    for (std::size_t i = 0; i < n; ++i)
      if ((set >> i & 1) == 0)
        values[i] += factorial(size) * factorial(n - size - 1) / factorial(n) *
                     (worths[set | std::size_t{1} << i] - worths[set]);
  }
  return values;
}

std::vector<EffectShare> effect_shares(const Experiment& fitted_on, const Experiment& held_out,
                                       const SearchResult& result, const HypothesisFit& fit) {
  const std::vector<const Effect*>& effects = fit.hypothesis.effects();
  if (effects.size() < 2) return {};
  bool defined = true;
  double of_calibrations = 0.;
  const auto worth = [&](std::size_t set) {
    std::vector<const Effect*> part;
    for (std::size_t i = 0; i < effects.size(); ++i)
      if ((set >> i & 1) != 0) part.push_back(effects[i]);
    const HypothesisFit of_part = fit_of(fitted_on, result, Hypothesis(part));
    const ErrorScore score =
        score_held_out(fitted_on, held_out, of_part, {.n_resamples = 0}).overall;
    defined = defined && score.gap_closed.has_value();
    if (set == 0) of_calibrations = score.gap_closed.value_or(0.);
    return score.gap_closed.value_or(0.);
  };
  const std::vector<double> values = shapley_values(effects.size(), worth);
  if (!defined) return {};
  std::vector<EffectShare> shares;
  for (std::size_t i = 0; i < effects.size(); ++i) shares.push_back({effects[i]->id, values[i]});
  shares.push_back({"calibrations", of_calibrations});
  return shares;
}

}  // namespace vibrissa::diagnosis
