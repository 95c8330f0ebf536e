#include "diagnosis/validation/attribution.h"

#include <gmock/gmock.h>

#include <bit>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

TEST(ShapleyValues, OfAnAdditiveGameAreThePlayersOwnWorths) {
  const double own[] = {1., 2., 4.};
  const auto worth = [&](std::size_t set) {
    double sum = 0.5;
    for (std::size_t i = 0; i < 3; ++i)
      if ((set >> i & 1) != 0) sum += own[i];
    return sum;
  };
  EXPECT_THAT(shapley_values(3, worth), testing::Pointwise(testing::DoubleNear(1e-12), own));
}

TEST(ShapleyValues, OfTheGloveGameAreTwoThirdsAndASixth) {
  // Player 0 has a left glove, 1 and 2 a right one each; a pair is worth 1 (Shapley and Shubik).
  const auto worth = [](std::size_t set) { return (set & 1) != 0 && (set & 6) != 0 ? 1. : 0.; };
  EXPECT_THAT(shapley_values(3, worth),
              testing::Pointwise(testing::DoubleNear(1e-12), {2. / 3., 1. / 6., 1. / 6.}));
}

struct Rig {
  Experiment fit_records, held_out;

  explicit Rig(const test::OneModeRig& rig) {
    const NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
    const signals::Dataset dataset = test::rig_dataset(rig);
    fit_records = prepare_experiment(nominal, dataset, signals::Split::fit, InputNoise::reduced);
    held_out =
        prepare_experiment(nominal, dataset, signals::Split::held_out, InputNoise::as_measured);
  }
  Attribution attributed(const std::vector<const Effect*>& effects) const {
    return attribute_gap(fit_records, held_out, fit_hypothesis(fit_records, Hypothesis(effects)));
  }
};

TEST(Attribution, OfADelayAndASofterSpringSumsToTheGapThatTheyClose) {
  test::OneModeRig rig = test::noisy_rig();
  rig.delay_s = 2e-3;
  rig.stiffness = 0.97;
  const Attribution found = Rig(rig).attributed({&find_effect("delay")});
  double sum = 0.;
  for (const AttributedChange& change : found.changes) {
    sum += change.share;
    if (change.id != "delay" && change.id != "stiffness") continue;
    EXPECT_GT(change.share, 0.1) << change.id;
    EXPECT_GT(change.missed, 0.1) << change.id;
    ASSERT_TRUE(change.share_ci95) << change.id;
    EXPECT_LT((*change.share_ci95)[0], change.share);
    EXPECT_GT((*change.share_ci95)[1], change.share);
  }
  EXPECT_NEAR(sum + found.unexplained, 1., 0.05);
  EXPECT_THAT(named_calibrations(found, 0.01), testing::ElementsAre("stiffness"));
}

TEST(Attribution, NamesTheCalibrationsThatMovedWithTheirValues) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 0.8;
  rig.loss = 0.5;
  const Attribution found = Rig(rig).attributed({});
  EXPECT_THAT(named_calibrations(found, 0.01), testing::ElementsAre("damping", "stiffness"));
  EXPECT_LT(found.unexplained, 0.01);
  ASSERT_FALSE(found.changes.empty());
  EXPECT_EQ(found.changes.front().id, "stiffness");
  EXPECT_NEAR(found.changes.front().parameters.front().value, 0.8, 0.01);
}

TEST(Attribution, NamesNoCalibrationThatClosesLessThanASimulationIsAccurate) {
  test::OneModeRig rig = test::noisy_rig();
  rig.moment_noise *= 0.01;
  rig.acceleration_noise *= 0.01;
  rig.stiffness = 0.9995;
  const Attribution found = Rig(rig).attributed({});
  EXPECT_GT(found.reducible, 0.);
  EXPECT_TRUE(named_calibrations(found, 0.01).empty());
  EXPECT_FALSE(named_calibrations(found, 0.001).empty());
}

}  // namespace
}  // namespace vibrissa::diagnosis
