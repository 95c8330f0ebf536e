#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "diagnosis/search/search.h"

namespace vibrissa::diagnosis {

/// Shortest list of candidates, most probable first, whose probabilities reach the level.
std::vector<std::string> confidence_set(const std::vector<Candidate>& candidates, double level);

/// The same of all that may be: candidates that have probability_of_tried together, the first of
/// them the verdict, and outside_catalogue, tried or not, with a probability of its own. The level
/// is of what these have together: what else may be has no name. Proven by
/// tests/diagnosis/search/confidence_set_test.cc.
std::vector<std::string> confidence_set(const std::vector<Candidate>& candidates, double level,
                                        double probability_of_tried, double probability_of_outside);

/// How many of a set say what it is: all but outside_catalogue, which no record rules out.
std::size_t n_known(const std::vector<std::string>& confidence_set);

}  // namespace vibrissa::diagnosis
