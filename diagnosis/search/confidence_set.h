#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "diagnosis/search/search.h"

namespace vibrissa::diagnosis {

/// Shortest list of candidates, most probable first, whose total probability reaches the level.
std::vector<std::string> confidence_set(const std::vector<Candidate>& candidates, double level);

/// The same including untested causes: the candidates (the first is the verdict) have
/// probability_of_tried together, and outside_catalogue has probability_of_outside. The level
/// refers to their total probability. Proven by tests/diagnosis/search/confidence_set_test.cc.
std::vector<std::string> confidence_set(const std::vector<Candidate>& candidates, double level,
                                        double probability_of_tried, double probability_of_outside);

/// Number of known answers in a set: all except outside_catalogue, which no record can exclude.
std::size_t n_known(const std::vector<std::string>& confidence_set);

}  // namespace vibrissa::diagnosis
