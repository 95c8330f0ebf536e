#pragma once

#include <string>
#include <vector>

#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// An effect that these data cannot show: it is neither detected nor excluded.
struct UntestedEffect {
  std::string effect{}, reason{};
};

/// Effects of the catalogue that the experiment cannot show, in alphabetical order. Proven by
/// tests/diagnosis/validation/untested_test.cc.
std::vector<UntestedEffect> untested_effects(const Experiment& experiment);

/// The effects grouped by reason, as one line; empty when there are none.
std::string untested_sentence(const std::vector<UntestedEffect>& untested);

}  // namespace vibrissa::diagnosis
