#include "trial/generator/calibration_draw.h"

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <string>

#include "trial/generator/trial_case.h"

namespace vibrissa::trial {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::Ge;
using testing::Le;

auto within(double low, double high) {
  return AllOf(Ge(low), Le(high));
}

World drawn(Distance distance, unsigned seed) {
  std::mt19937_64 random(seed);
  World out;
  draw_calibrations(out, distance, random);
  return out;
}

TEST(CalibrationDraw, AsInThePaperLiesInItsRanges) {
  const auto gain = AnyOf(within(0.8, 0.95), within(1.05, 1.2));
  for (unsigned seed = 0; seed < 300; ++seed) {
    const World world = drawn(Distance::as_paper, seed);
    EXPECT_THAT(world.solid.silicone_modulus, within(0.55, 0.9));
    EXPECT_THAT(world.damping, within(0.45, 0.85));
    EXPECT_THAT(world.sensor_gain, gain);
    EXPECT_THAT(world.reference_gain, gain);
    EXPECT_THAT(world.drag, AnyOf(within(0.65, 0.9), within(1.1, 1.35)));
  }
}

constexpr double cut = 2. * (1. + 1e-9);  // standard deviations

TEST(CalibrationDraw, AsBuiltIsAFewPercentAndExactIsNothing) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    const World world = drawn(Distance::as_built, seed);
    EXPECT_NEAR(world.solid.silicone_modulus, 1., cut * built_modulus);
    EXPECT_NEAR(world.damping, 1., cut * built_damping);
    EXPECT_NEAR(world.sensor_gain, 1., cut * built_gain);
    EXPECT_NEAR(world.drag, 1., cut * built_drag);
    for (const auto& [id, ratio] : calibrations_of(drawn(Distance::exact, seed)))
      EXPECT_EQ(ratio, 1.) << id;
  }
}

TEST(CalibrationDraw, DeviatesAsTheObserverAssumes) {
  constexpr unsigned n = 2000;
  for (const Distance distance : {Distance::as_built, Distance::as_paper}) {
    std::map<std::string, double> sum, square;
    for (unsigned seed = 0; seed < n; ++seed)
      for (const auto& [id, ratio] : calibrations_of(drawn(distance, seed))) {
        sum[id] += ratio / n;
        square[id] += ratio * ratio / n;
      }
    // A cut at two standard deviations takes an eighth of the deviation.
    for (const auto& [id, deviation] : calibration_deviations(distance))
      EXPECT_NEAR(std::sqrt(square[id] - sum[id] * sum[id]) / deviation, 0.97, 0.1) << id;
  }
  EXPECT_EQ(calibration_deviations(Distance::exact), calibration_deviations(Distance::as_built))
      << "nobody knows that a sensor is exactly as designed";
}

TEST(CalibrationDraw, NoEffectIsAskedThatCalibrationsImitate) {
  for (const std::size_t number : {1u, 3u, 5u, 10u}) {
    const TrialCase drawn = draw_case(31, number, Physics::modes, {.distance = Distance::as_paper});
    ASSERT_FALSE(drawn.effects.empty());
    for (const CaseEffect& effect : drawn.effects) EXPECT_FALSE(is_a_calibration(effect.id));
    EXPECT_LT(drawn.plain.solid.silicone_modulus, 1.);
  }
}

}  // namespace
}  // namespace vibrissa::trial
