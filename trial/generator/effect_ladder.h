#pragma once

#include <complex>
#include <vector>

#include "trial/generator/unexplained_change.h"
#include "trial/generator/unknowns.h"

namespace vibrissa::trial {

/// One unknown of one shape over a ladder of sizes, from below the detection limit of the quietest
/// bench to the largest that is usual.
struct EffectLadder {
  const Unknown* unknown = nullptr;
  std::vector<double> sizes;
  std::vector<std::vector<std::complex<float>>> changes;  // unexplained [size][line]
};

/// All named unknowns, some in several shapes. on_unknown: called after each.
std::vector<EffectLadder> optimise_ladders(const UnexplainedChange& change,
                                           const std::function<void()>& on_unknown);

}  // namespace vibrissa::trial
