#pragma once

#include <string>
#include <vector>

#include "diagnosis/search/search.h"

namespace vibrissa::diagnosis {

/// Sets of effects that this experiment cannot distinguish, for the most probable candidate; the
/// first member is the effect that it names. Members differ by less than two nats. Each other
/// effect is compared by a fit in its place, with all unnamed calibration parameters exactly
/// nominal. A named calibration effect is also compared by projection: its tangent times its size
/// (whitened mean and log variance) on the tangent of each other effect, with the other nuisances,
/// the noise levels and the effects of the hypothesis free within twice the spread of their priors.
/// Proven by tests/diagnosis/validation/indistinguishable_test.cc.
std::vector<std::vector<std::string>> indistinguishable_sets(const Experiment& experiment,
                                                             const SearchResult& result);

}  // namespace vibrissa::diagnosis
