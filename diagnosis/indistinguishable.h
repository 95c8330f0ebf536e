#pragma once

#include <string>
#include <vector>

#include "diagnosis/search.h"

namespace vibrissa::diagnosis {

/// Sets of effects of which this experiment cannot say which it is: for each effect that the
/// candidate names, what it does at the size found (whitened change of mean and of log variance) is
/// projected on what each other effect does, with the nuisances, the noise levels and the other
/// effects of the hypothesis free within their priors. Less than two nats left: not told apart.
/// First member: the named effect. Proven by tests/diagnosis/indistinguishable_test.cc.
std::vector<std::vector<std::string>> indistinguishable_sets(const Experiment& experiment,
                                                             const HypothesisFit& fit,
                                                             const Candidate& candidate);

}  // namespace vibrissa::diagnosis
