#pragma once

#include <complex>
#include <vector>

#include "trial/generator/unexplained_change.h"
#include "trial/generator/unknowns.h"

namespace vibrissa::trial {

/// One effect of one shape at a ladder of sizes, from below the detection limit of the quietest
/// bench to the largest usual size.
struct EffectLadder {
  const Unknown* unknown = nullptr;
  std::vector<double> sizes;
  std::vector<std::vector<std::complex<float>>> changes;  // unexplained [size][line]
  /// Change of the power of an unmeasured wind [size][line]; empty where the wind is measured, and
  /// for random effects, whose changes contain it.
  std::vector<std::vector<float>> wind_power{};
};

/// Ladders of all named effects, some with several shapes. on_unknown: called after each effect.
std::vector<EffectLadder> effect_ladders(const UnexplainedChange& change,
                                         const std::function<void()>& on_unknown);

}  // namespace vibrissa::trial
