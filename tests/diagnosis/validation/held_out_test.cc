#include "diagnosis/validation/held_out.h"

#include <gmock/gmock.h>

#include "signals/base/error.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using signals::Split;

struct Scored {
  HypothesisFit fit;
  HeldOutScore score;
};

Scored scored(const test::OneModeRig& rig, const std::vector<const Effect*>& effects) {
  const signals::Dataset dataset = test::rig_dataset(rig);
  const NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
  const Experiment fit_records =
      prepare_experiment(nominal, dataset, Split::fit, InputNoise::reduced);
  const Experiment held_out =
      prepare_experiment(nominal, dataset, Split::held_out, InputNoise::as_measured);
  HypothesisFit fit = fit_hypothesis(fit_records, Hypothesis(effects));
  HeldOutScore score = score_held_out(fit_records, held_out, fit);
  return {std::move(fit), std::move(score)};
}

TEST(HeldOut, ClosesTheGapOfAKnownDelayDownToTheNoise) {
  test::OneModeRig rig = test::noisy_rig();
  rig.delay_s = 1e-3;
  const ErrorScore score = scored(rig, {&find_effect("delay")}).score.overall;
  EXPECT_GT(score.nrmse_before, 3. * score.noise_floor);
  ASSERT_TRUE(score.gap_closed && score.gap_closed_ci95);
  EXPECT_NEAR(*score.gap_closed, 1., 0.03);
  EXPECT_LT((*score.gap_closed_ci95)[0], *score.gap_closed);
  EXPECT_GT((*score.gap_closed_ci95)[1], *score.gap_closed);
}

TEST(HeldOut, FloorIsTheErrorOfTheTrueModel) {
  test::OneModeRig of_moment = test::noisy_rig();
  of_moment.moment_noise = 1e-5;
  // By the noise of the accelerometer, then of the moment.
  for (const test::OneModeRig& rig : {test::noisy_rig(), of_moment}) {
    const ErrorScore score = scored(rig, {}).score.overall;
    // Each of the 1400 samples is filtered noise with a memory of about five samples.
    EXPECT_NEAR(score.nrmse_after / score.noise_floor, 1., 0.1);
    EXPECT_NEAR(score.nrmse_before / score.noise_floor, 1., 0.1);
  }
}

TEST(HeldOut, PredictsTheSecondHalfOfAHum) {
  test::OneModeRig rig = test::noisy_rig();
  rig.hum = 2e-5;
  const Scored hum = scored(rig, {&find_effect("hum")});
  EXPECT_THAT(hum.score.predicted, testing::ElementsAre("hum"));
  ASSERT_TRUE(hum.score.overall.gap_closed);
  EXPECT_GT(*hum.score.overall.gap_closed, 0.9);
}

TEST(HeldOut, ClosesNothingWithoutTheEffect) {
  test::OneModeRig rig = test::noisy_rig();
  rig.hum = 2e-5;
  const Scored none = scored(rig, {});
  ASSERT_TRUE(none.score.overall.gap_closed);
  EXPECT_LT(*none.score.overall.gap_closed, 0.2);
}

TEST(HeldOut, RefusesToScoreNothing) {
  const signals::Dataset dataset = test::rig_dataset(test::noisy_rig(), {.held_out = false});
  const NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
  const Experiment fit_records =
      prepare_experiment(nominal, dataset, Split::fit, InputNoise::reduced);
  const Experiment held_out =
      prepare_experiment(nominal, dataset, Split::held_out, InputNoise::as_measured);
  const HypothesisFit fit = fit_hypothesis(fit_records, Hypothesis{});
  EXPECT_THROW(score_held_out(fit_records, held_out, fit), signals::UserError);
}

}  // namespace
}  // namespace vibrissa::diagnosis
