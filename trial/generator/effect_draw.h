#pragma once

#include <optional>
#include <random>
#include <vector>

#include "trial/generator/detection_limit.h"
#include "trial/generator/trial_case.h"

namespace vibrissa::trial {

/// Sizes in multiples of the detection limit.
struct Sizes {
  double low = smallest_in_limits, high = largest_in_limits;
};

/// Adds effects of random sizes to a case: log-uniform in multiples of the detection limit on its
/// bench, within the usual range. Proven by tests/trial/generator/detection_limit_test.cc.
class EffectDraw {
 public:
  /// of: a case that is as simulated, on its own bench. Both arguments must outlive this object.
  EffectDraw(TrialCase& of, std::mt19937_64& random)
      : case_(of), plain_(of.world), random_(random) {}

  void add_by_chance(const std::vector<Unknown>& list, const Sizes& sizes = {});
  /// The next effect of the list (cyclic) that is detectable on this bench.
  void add_in_turn(const std::vector<Unknown>& list, std::size_t turn, const Sizes& sizes = {});

 private:
  bool try_to_add(const Unknown& unknown, const Sizes& sizes);
  std::optional<double> limit(const Unknown& unknown, double sign, double shape);

  TrialCase& case_;
  World plain_;
  std::mt19937_64& random_;
  std::optional<LikelihoodRatio> test_;  // created for the first effect
};

}  // namespace vibrissa::trial
