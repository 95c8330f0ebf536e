#include "trial/generator/effect_ladder.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "trial/generator/detection_limit.h"

namespace vibrissa::trial {
namespace {

constexpr double step = 1.5, below_the_limit = 0.7;

/// Further parameters (shapes) of an effect beside its size.
std::vector<double> shapes_of(const Unknown& unknown) {
  static const std::map<std::string, std::vector<double>> several{{"joint_friction", {0.1, 0.9}},
                                                                  {"extra_mode", {0.1, 0.5, 0.9}},
                                                                  {"hum", {0.1, 0.3, 0.6, 0.9}},
                                                                  {"sample_repeat", {0.2, 0.8}}};
  const auto found = several.find(unknown.id);
  return found == several.end() ? std::vector<double>{0.5} : found->second;
}

std::vector<double> sizes_of(const Unknown& unknown, const double limit) {
  if (unknown.fixed_size) return {unknown.largest};
  const double low = std::min(below_the_limit * limit, 0.5 * unknown.largest);
  const double decades = std::log(unknown.largest / low);
  const int n = static_cast<int>(std::ceil(decades / std::log(step)));
  std::vector<double> out;
  for (int i = 0; i <= n; ++i) out.push_back(low * std::exp(decades * i / n));
  return out;
}

}  // namespace

std::vector<EffectLadder> effect_ladders(const UnexplainedChange& change,
                                         const std::function<void()>& on_unknown) {
  World quietest = change.plain();
  quietest.moment_noise = quietest_moment;
  quietest.acceleration_noise = quietest_accelerometer;
  const LikelihoodRatio test(quietest, {.takes = usual_takes()});
  std::vector<EffectLadder> out;
  for (const Unknown& unknown : named_unknowns()) {
    for (const double shape : shapes_of(unknown)) {
      const std::optional<double> limit = detection_limit(test, unknown, 1., shape);
      if (!limit) continue;
      EffectLadder ladder{.unknown = &unknown, .sizes = sizes_of(unknown, *limit), .changes = {}};
      for (const double size : ladder.sizes) {
        World world = change.plain();
        unknown.apply(world, size, shape);
        ladder.changes.push_back(change_of(change, world, unknown.random));
      }
      out.push_back(std::move(ladder));
    }
    on_unknown();
  }
  return out;
}

}  // namespace vibrissa::trial
