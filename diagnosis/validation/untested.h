#pragma once

#include <string>
#include <vector>

#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// An effect that these data cannot show at all: it is neither found nor excluded.
struct UntestedEffect {
  std::string effect{}, reason{};
};

/// Effects of the catalogue that the experiment does not show, alphabetical. Proven by
/// tests/diagnosis/validation/untested_test.cc.
std::vector<UntestedEffect> untested_effects(const Experiment& experiment);

/// Effects joined by their reason, for one line; empty when there is none.
std::string untested_sentence(const std::vector<UntestedEffect>& untested);

}  // namespace vibrissa::diagnosis
