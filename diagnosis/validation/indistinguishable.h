#pragma once

#include <string>
#include <vector>

#include "diagnosis/search/search.h"

namespace vibrissa::diagnosis {

/// Sets of effects of which this experiment cannot say which it is, for the most probable
/// candidate; first member: the effect that it names. Fewer than two nats between them. Against
/// what the data say of each other effect fitted in its place, where all calibrations that are not
/// named are exactly nominal. A calibration parameter, too: its tangent times its size (whitened
/// mean and log variance) projected on the tangent of each other effect, with the other nuisances,
/// the noise levels and the effects of the hypothesis free within twice the spread of their priors.
/// Proven by tests/diagnosis/validation/indistinguishable_test.cc.
std::vector<std::vector<std::string>> indistinguishable_sets(const Experiment& experiment,
                                                             const SearchResult& result);

}  // namespace vibrissa::diagnosis
