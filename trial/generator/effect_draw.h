#pragma once

#include <optional>
#include <random>
#include <vector>

#include "trial/generator/detection_limit.h"
#include "trial/generator/trial_case.h"

namespace vibrissa::trial {

/// In detection limits.
struct Sizes {
  double low = smallest_in_limits, high = largest_in_limits;
};

/// Adds effects to a case, each of a size by chance that its bench shows: log-uniform in detection
/// limits, within the usual range. Proven by tests/trial/generator/detection_limit_test.cc.
class EffectDraw {
 public:
  /// The case as it is on its bench, else as simulated. Both must outlive it.
  EffectDraw(TrialCase& of, std::mt19937_64& random)
      : case_(of), plain_(of.world), random_(random) {}

  void add_by_chance(const std::vector<Unknown>& list, const Sizes& sizes = {});
  /// The first of the list that can be asked, from the one whose turn it is.
  void add_in_turn(const std::vector<Unknown>& list, std::size_t turn, const Sizes& sizes = {});

 private:
  bool try_to_add(const Unknown& unknown, const Sizes& sizes);
  std::optional<double> limit(const Unknown& unknown, double sign, double shape);

  TrialCase& case_;
  World plain_;
  std::mt19937_64& random_;
  std::optional<LikelihoodRatio> test_;  // when the first effect is asked
};

}  // namespace vibrissa::trial
