#pragma once

#include <functional>
#include <string>
#include <vector>

#include "diagnosis/search/search.h"

namespace vibrissa::diagnosis {

/// Shares of n players in what they reach together, by Shapley (1953): the mean over all orders of
/// what each adds. worth(set): what the players of a bit set reach; n small. The shares sum to
/// worth(all) - worth(none). Proven by tests/diagnosis/validation/shares_test.cc.
std::vector<double> shapley_values(std::size_t n, const std::function<double(std::size_t)>& worth);

/// An effect of a combination with its share of the gap closed on held-out records.
struct EffectShare {
  std::string effect{};
  double share = 0.;
};

/// Of each effect of a fit with two or more, and of the calibrations that are free without any of
/// them
/// ("calibrations", last); empty where no gap is to be closed. Fits of the parts that the search
/// has not made are made.
std::vector<EffectShare> effect_shares(const Experiment& fitted_on, const Experiment& held_out,
                                       const SearchResult& result, const HypothesisFit& fit);

}  // namespace vibrissa::diagnosis
