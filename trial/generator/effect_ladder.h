#pragma once

#include <functional>
#include <vector>

#include "trial/generator/signature.h"
#include "trial/generator/unknowns.h"

namespace vibrissa::trial {

/// One effect of one shape at a ladder of sizes, from below the detection limit of the quietest
/// bench to the largest usual size.
struct EffectLadder {
  const Unknown* unknown = nullptr;
  std::vector<double> sizes;
  std::vector<LineChange> changes;  // one for each size
};

/// Ladders of all named effects, some with several shapes. on_unknown: called after each effect.
std::vector<EffectLadder> effect_ladders(const UnexplainedChange& change,
                                         const std::function<void()>& on_unknown);

}  // namespace vibrissa::trial
