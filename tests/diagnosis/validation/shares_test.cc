#include "diagnosis/validation/shares.h"

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

TEST(EffectShares, OfADelayAndAHardSpringSumToTheGapThatTheyClose) {
  test::OneModeRig rig = test::noisy_rig();
  rig.delay_s = 5e-4;
  rig.cubic = 3e6;
  const NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
  const signals::Dataset dataset = test::rig_dataset(rig);
  const Experiment fit_records =
      prepare_experiment(nominal, dataset, signals::Split::fit, InputNoise::reduced);
  const Experiment held_out =
      prepare_experiment(nominal, dataset, signals::Split::held_out, InputNoise::as_measured);
  const HypothesisFit fit =
      fit_hypothesis(fit_records, Hypothesis({&find_effect("delay"), &find_effect("hardening")}));
  const std::vector<EffectShare> shares = effect_shares(fit_records, held_out, {}, fit);
  ASSERT_EQ(shares.size(), 3u);
  double sum = 0.;
  for (const EffectShare& share : shares) sum += share.share;
  EXPECT_NEAR(sum, 1., 0.05);
  EXPECT_EQ(shares[0].effect, "delay");
  EXPECT_GT(shares[0].share, 0.1);
  EXPECT_GT(shares[1].share, 0.1);
  EXPECT_TRUE(effect_shares(fit_records, held_out, {},
                            fit_hypothesis(fit_records, Hypothesis({&find_effect("delay")})))
                  .empty());
}

}  // namespace
}  // namespace vibrissa::diagnosis
