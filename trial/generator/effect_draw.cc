#include "trial/generator/effect_draw.h"

#include <algorithm>
#include <cmath>

namespace vibrissa::trial {

void EffectDraw::add_by_chance(const std::vector<Unknown>& list, const Sizes& sizes) {
  while (!try_to_add(list[random_() % list.size()], sizes)) continue;
}

void EffectDraw::add_in_turn(const std::vector<Unknown>& list, std::size_t turn,
                             const Sizes& sizes) {
  while (!try_to_add(list[turn % list.size()], sizes)) ++turn;
}

bool EffectDraw::try_to_add(const Unknown& unknown, const Sizes& sizes) {
  std::uniform_real_distribution<double> uniform;
  const double sign = unknown.either_sign && uniform(random_) < 0.5 ? -1. : 1.;
  const double shape = uniform(random_), place = uniform(random_);
  if (std::any_of(case_.effects.begin(), case_.effects.end(),
                  [&](const CaseEffect& there) { return there.id == unknown.id; }))
    return false;
  const std::optional<double> least = limit(unknown, sign, shape);
  if (!least || (unknown.fixed_size && sizes.high < 1.)) return false;
  const double largest = std::min(sizes.high, unknown.largest / *least);
  if (largest < sizes.low) return false;
  const double size = unknown.fixed_size
                          ? unknown.largest
                          : *least * sizes.low * std::pow(largest / sizes.low, place);
  unknown.apply(case_.world, sign * size, shape);
  case_.effects.push_back({unknown.id, sign * size, *least, shape});
  return true;
}

std::optional<double> EffectDraw::limit(const Unknown& unknown, const double sign,
                                        const double shape) {
  if (!test_) test_.emplace(plain_, case_.session, case_.circumstances.distance, case_.accuracy);
  return detection_limit(*test_, unknown, sign, shape);
}

}  // namespace vibrissa::trial
