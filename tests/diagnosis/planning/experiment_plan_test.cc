#include "diagnosis/planning/experiment_plan.h"

#include <gmock/gmock.h>

#include "signals/base/error.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Pair;

const test::OneModeRig plan_rig;

ExperimentPlan plan_of(bool wind_known, bool wind_planned) {
  const NominalModel nominal = test::nominal_of(plan_rig, wind_known);
  return plan_experiments(
      nominal,
      inputs_of(nominal, test::rig_dataset(plan_rig, {.wind = wind_planned, .held_out = false})),
      usual_noise());
}

const PlannedStep& step_of(const ExperimentPlan& plan, const std::string& name) {
  return *std::find_if(plan.steps.begin(), plan.steps.end(),
                       [&](const PlannedStep& step) { return step.name == name; });
}

TEST(ExperimentPlan, WithoutWindItAsksForWind) {
  const ExperimentPlan plan = plan_of(true, false);
  const PlannedStep& first = plan.steps.front();
  EXPECT_EQ(first.name, "wind_ladder");
  EXPECT_FALSE(first.by_rule);
  EXPECT_THAT(first.finds, IsSupersetOf({"flow_lag", "turbulence", "relative_drag"}));
  EXPECT_THAT(first.separates, Contains(Pair("reference_gain", "sensor_gain")));
  // With planned wind the experiment adds less.
  const ExperimentPlan windy = plan_of(true, true);
  EXPECT_LT(step_of(windy, "wind_ladder").gain, 0.3 * first.gain);
  EXPECT_LT(windy.undecided, plan.undecided - 0.5 * first.gain);
}

TEST(ExperimentPlan, MoreRecordsNeverTakeAway) {
  const ExperimentPlan plan = plan_of(true, false);
  ASSERT_EQ(plan.steps.size(), experiment_menu().size());
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    EXPECT_GE(plan.steps[i].gain, -1e-12) << plan.steps[i].name;
    EXPECT_LE(plan.steps[i].gain, plan.steps[i == 0 ? 0 : i - 1].gain);
  }
  EXPECT_GT(plan.undecided, 0.);
  EXPECT_LT(plan.undecided, 1.);
}

TEST(ExperimentPlan, SaysWhatItCouldNotSimulate) {
  const ExperimentPlan plan = plan_of(false, false);
  EXPECT_TRUE(step_of(plan, "wind_ladder").by_rule);
  EXPECT_TRUE(step_of(plan, "added_mass").by_rule);
  EXPECT_FALSE(step_of(plan, "level_ladder").by_rule);
}

TEST(ExperimentPlan, CallsBackAsOftenAsItSays) {
  const NominalModel nominal = test::nominal_of(plan_rig, false);
  const auto inputs = inputs_of(nominal, test::rig_dataset(plan_rig, {.held_out = false}));
  std::size_t n = 0;
  plan_experiments(nominal, inputs, usual_noise(), {.on_effect = [&] { ++n; }});
  EXPECT_EQ(n, n_plan_steps(nominal, inputs));
}

TEST(ExperimentPlan, RefusesNoiseThatIsNone) {
  const NominalModel nominal = test::nominal_of(plan_rig, false);
  const auto inputs = inputs_of(nominal, test::rig_dataset(plan_rig, {.held_out = false}));
  for (const double bad : {0., -1., std::numeric_limits<double>::quiet_NaN()}) {
    try {
      plan_experiments(nominal, inputs, {.moment_n_m = bad, .acceleration_m_s2 = 0.05});
      FAIL() << bad;
    } catch (const signals::UserError& error) {
      EXPECT_THAT(error.what(), HasSubstr("noise of the moment"));
    }
  }
}

TEST(UndecidedProbability, CountsEffectsUnfoundAndMistaken) {
  const auto detectability = [](bool detected, std::vector<std::string> alike) {
    return Detectability{.detected = detected, .alike = std::move(alike)};
  };
  const auto effect = [&](const std::string& id, const Detectability& both) {
    return EffectPower{.effect = id, .shown = true, .exact = both, .as_built = both};
  };
  // Both have the same prior: delay is named right half of the time, hum always, mass never.
  EXPECT_NEAR(undecided_probability({effect("delay", detectability(true, {"sensor_lowpass"})),
                                     effect("hum", detectability(true, {})),
                                     effect("mass", detectability(false, {}))}),
              (0.5 + 0. + 1.) / 3., 1e-12);
}

}  // namespace
}  // namespace vibrissa::diagnosis
