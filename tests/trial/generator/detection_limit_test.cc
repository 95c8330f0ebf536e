#include "trial/generator/detection_limit.h"

#include <gmock/gmock.h>

#include <cmath>

#include "trial/generator/trial_case.h"
#include "trial/plant/solid_motion.h"

namespace vibrissa::trial {
namespace {

World noisy() {
  World world;
  world.joint.scale = 9.4e-3;
  world.moment_noise = 1e-6;
  world.acceleration_noise = 0.04;
  return world;
}

Session usual() {
  return {.takes = usual_takes()};
}

TEST(DetectionLimit, OfAFeedthroughMeetsTheClosedForm) {
  // M + beta a: the non-centrality is beta^2 sum |a|^2 / noise, nearly all of it where the
  // accelerometer's noise, carried through the sensor, is small.
  const Unknown& feedthrough = find_unknown("coil_feedthrough");
  const auto limit = detection_limit(LikelihoodRatio(noisy(), usual()), feedthrough, 1., 0.5);
  ASSERT_TRUE(limit);
  World there = noisy();
  feedthrough.apply(there, *limit, 0.5);
  EXPECT_NEAR(LikelihoodRatio(noisy(), usual()).noncentrality(there, false), 6.63, 1.5);
  const double beta = there.feedthrough;
  double energy = 0.;
  for (const Take& take : usual_takes())
    if (take.split == signals::Split::fit)
      energy += static_cast<double>(take.n_samples) * take.base_rms * take.base_rms;
  const double without_accelerometer = beta * beta * energy / 1e-12;
  EXPECT_GT(without_accelerometer, 6.63);
  EXPECT_LT(without_accelerometer, 6.63 * 40.);
}

TEST(DetectionLimit, GoesWithTheNoise) {
  const Unknown& delay = find_unknown("delay");
  World louder = noisy();
  louder.moment_noise *= 3.;
  louder.acceleration_noise *= 3.;
  const auto quiet = detection_limit(LikelihoodRatio(noisy(), usual()), delay, 1., 0.5);
  const auto loud = detection_limit(LikelihoodRatio(louder, usual()), delay, 1., 0.5);
  ASSERT_TRUE(quiet && loud);
  EXPECT_NEAR(*loud / *quiet, 3., 0.4);
}

TEST(DetectionLimit, OfANoisyAccelerometerIsBeyondTheLoudestUsualOne) {
  const Unknown& unknown = find_unknown("reference_noise");
  World quiet = noisy();
  quiet.acceleration_noise = quietest_accelerometer;
  const auto limit = detection_limit(LikelihoodRatio(quiet, usual()), unknown, 1., 0.5);
  ASSERT_TRUE(limit);
  EXPECT_GE(std::hypot(*limit, quietest_accelerometer), loudest_accelerometer * (1. - 1e-12));
}

TEST(DrawCase, IsTheSameForTheSameSeed) {
  const TrialCase one = draw_case(3, 1), two = draw_case(3, 1);
  ASSERT_EQ(one.effects.size(), 2u);
  EXPECT_EQ(one.effects[0].id, two.effects[0].id);
  EXPECT_EQ(one.effects[0].size, two.effects[0].size);
  EXPECT_NE(one.effects[0].id, one.effects[1].id);
  for (const CaseEffect& effect : one.effects)
    EXPECT_GE(std::abs(effect.size) / effect.limit, 0.99) << effect.id;
}

TEST(DrawCase, TakesEachEffectOutOfTheCatalogueInTurn) {
  // Two cases of twenty; an effect that is not detectable on a bench is replaced by the next one.
  std::vector<std::string> left_out;
  for (const std::size_t number : {6u, 15u, 26u, 35u, 46u}) {
    const TrialCase drawn = draw_case(3, number);
    ASSERT_EQ(drawn.kind, CaseClass::left_out) << number;
    ASSERT_EQ(drawn.left_out.size(), 1u);
    EXPECT_EQ(drawn.left_out.front(), drawn.effects.front().id);
    left_out.push_back(drawn.left_out.front());
  }
  // In the order of the catalogue, without effects that have an exact alias.
  EXPECT_THAT(left_out, testing::ElementsAre("hardening", "viscoelastic", "softening_history",
                                             "temperature_drift", "joint_friction"));
}

TEST(DrawCase, OfFiniteStrainAsksWhatTheSolidCanDo) {
  for (std::size_t number = 0; number < 10; ++number) {
    const TrialCase drawn = draw_case(3, number, Physics::finite_strain);
    EXPECT_TRUE(is_of_the_solid(drawn.world)) << number;
    EXPECT_TRUE(further_records_of(drawn).empty());
  }
}

TEST(DrawCase, RecordsOfASensorThatIsAsDesignedAreTheSimulationAndNoise) {
  TrialCase plain = draw_case(3, 2);
  ASSERT_EQ(plain.kind, CaseClass::none);
  plain.session.noise = false;
  const signals::Dataset records = records_of(plain);
  plain.world.moment_noise = 1.;
  const signals::Dataset again = records_of(plain);
  for (std::size_t r = 0; r < records.records.size(); ++r) {
    const auto a = records.records[r].record.channel(signals::channel::base_moment);
    const auto b = again.records[r].record.channel(signals::channel::base_moment);
    EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin())) << "free of noise";
  }
}

}  // namespace
}  // namespace vibrissa::trial
