#include "trial/generator/gap_share.h"

#include <gtest/gtest.h>

#include <cmath>

#include "trial/generator/record_set.h"
#include "trial/generator/unknowns.h"

namespace vibrissa::trial {
namespace {

/// A sensor at a distance from its design, with these effects.
TrialCase with(World plain, const std::vector<CaseEffect>& effects) {
  TrialCase out;
  plain.joint.scale = usual_turn;
  out.session.takes = takes_of(RecordSet::base_only);
  out.plain = out.world = plain;
  out.effects = effects;
  for (const CaseEffect& effect : effects)
    find_unknown(effect.id).apply(out.world, effect.size, effect.shape);
  return out;
}

TEST(GapShare, IsAllOfTheGapForASingleEffectOfASensorAsDesigned) {
  EXPECT_NEAR(gap_shares(with({}, {{.id = "delay", .size = 1e-4}})).at(0).value(), 1., 1e-9);
}

TEST(GapShare, OfTwoGainsIsInProportionToTheirSquares) {
  // The moment is 1.2 times the simulated one; without the gain of 1.02 it is 1.2 / 1.02 times.
  World plain;
  plain.sensor_gain = 1.2 / 1.02;
  const auto share = gap_shares(with(plain, {{.id = "sensor_gain", .size = 0.02}})).at(0);
  EXPECT_NEAR(share.value(), std::pow((1.2 - 1.2 / 1.02) / 0.2, 2), 1e-9);
}

TEST(GapShare, OfARandomEffectIsNone) {
  EXPECT_FALSE(gap_shares(with({}, {{.id = "hum", .size = 1e-5}})).at(0));
}

TEST(GapShare, WithoutAGapIsNone) {
  EXPECT_FALSE(gap_shares(with({}, {{.id = "drag_error", .size = 0.1}})).at(0));  // no wind
}

}  // namespace
}  // namespace vibrissa::trial
