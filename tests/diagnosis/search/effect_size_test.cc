#include "diagnosis/search/effect_size.h"

#include <gmock/gmock.h>

namespace vibrissa::diagnosis {
namespace {

using testing::ElementsAre;

TEST(EffectSize, FindsTheParametersThatMakeAnEffectVanish) {
  EXPECT_THAT(size_parameters(find_effect("delay")), ElementsAre(0u));
  EXPECT_THAT(size_parameters(find_effect("joint_friction")), ElementsAre(0u));
  // Frequency and damping of a mode without residue have no influence.
  EXPECT_THAT(size_parameters(find_effect("extra_mode")), ElementsAre(2u));
  // Each part alone leaves the other one.
  EXPECT_THAT(size_parameters(find_effect("sensor_nonlinearity")), ElementsAre(0u, 1u));
  EXPECT_THAT(size_parameters(find_effect("cross_axis")), ElementsAre(0u, 1u));
}

TEST(EffectSize, EveryEffectHasAFamilyThroughItsStarts) {
  for (const Effect& effect : effect_catalogue()) {
    const std::vector<std::size_t> sized = size_parameters(effect);
    ASSERT_FALSE(sized.empty()) << effect.id;
    for (const std::vector<double>& start : effect.starts) {
      const EffectFamily family(effect, sized, start);
      const std::vector<double> values = family.values(1.);
      for (std::size_t i = 0; i < start.size(); ++i)
        EXPECT_NEAR(values[i], start[i], 1e-12 * std::abs(start[i])) << effect.id;
      EXPECT_GE(family.largest_share(), 1.) << effect.id;
    }
  }
}

TEST(EffectSize, GoesToNeutralByRatioOrDifference) {
  const auto half = [](const std::string& id, std::vector<double> start) {
    const Effect& effect = find_effect(id);
    return EffectFamily(effect, size_parameters(effect), std::move(start)).values(0.5)[0];
  };
  EXPECT_NEAR(half("delay", {2e-4}), 1e-4, 1e-12);              // neutral 0, a difference
  EXPECT_NEAR(half("stiffness", {0.81, 0., 0.5}), 0.9, 1e-12);  // neutral 1, a ratio
  EXPECT_NEAR(half("flow_lag", {0.01}), 0.005, 1e-12);          // neutral 0, a logarithm
  EXPECT_NEAR(half("base_compliance", {10.}), 20., 1e-12);      // neutral at infinity
}

}  // namespace
}  // namespace vibrissa::diagnosis
