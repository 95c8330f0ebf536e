#pragma once

#include <functional>
#include <string>
#include <vector>

#include "diagnosis/search/search.h"

namespace vibrissa::diagnosis {

/// Shapley values (1953) of n players: each player's contribution, averaged over all orders.
/// worth(set): value of a set of players, given as bits; n must be small. The values sum to
/// worth(all) - worth(none). Proven by tests/diagnosis/validation/shares_test.cc.
std::vector<double> shapley_values(std::size_t n, const std::function<double(std::size_t)>& worth);

/// An effect of a combination with its share of the gap closed on held-out records.
struct EffectShare {
  std::string effect{};
  double share = 0.;
};

/// Share of each effect of a fit with two or more effects, and of the free calibration parameters
/// ("calibrations", last); empty when there is no gap. Missing fits of parts of the combination are
/// made.
std::vector<EffectShare> effect_shares(const Experiment& fitted_on, const Experiment& held_out,
                                       const SearchResult& result, const HypothesisFit& fit);

}  // namespace vibrissa::diagnosis
