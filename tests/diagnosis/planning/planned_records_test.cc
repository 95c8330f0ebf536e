#include "diagnosis/planning/planned_records.h"

#include <gmock/gmock.h>

#include "diagnosis/planning/next_experiment.h"
#include "signals/base/error.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

namespace channel = signals::channel;
using testing::HasSubstr;

const test::OneModeRig planned_rig;

double rms(std::span<const double> x) {
  double sum = 0.;
  for (const double value : x) sum += value * value;
  return std::sqrt(sum / static_cast<double>(x.size()));
}

std::vector<PlannedInput> rig_inputs(bool wind) {
  return inputs_of(test::nominal_of(planned_rig, wind),
                   test::rig_dataset(planned_rig, {.wind = wind}));
}

TEST(PlannedRecords, AreWhatTheRigMeasures) {
  const signals::Dataset truth = test::rig_dataset(planned_rig);
  const signals::Dataset planned =
      planned_dataset(test::nominal_of(planned_rig, false), rig_inputs(false),
                      {.moment_n_m = 1e-12, .acceleration_m_s2 = 1e-9});
  ASSERT_EQ(planned.records.size(), 3u);  // held-out records are not planned
  for (std::size_t r = 1; r < 3; ++r) {
    const auto expected = truth.records[r].record.channel(channel::base_moment);
    const auto moment = planned.records[r].record.channel(channel::base_moment);
    std::vector<double> error(moment.size());
    for (std::size_t i = 0; i < moment.size(); ++i) error[i] = moment[i] - expected[i];
    EXPECT_LT(rms(error), 2e-4 * rms(expected)) << r;
  }
}

TEST(PlannedRecords, CarryTheNoiseThatWasAskedFor) {
  const ChannelNoise noise{.moment_n_m = 3e-6, .acceleration_m_s2 = 0.2};
  const signals::Dataset planned =
      planned_dataset(test::nominal_of(planned_rig, false), {quiet_input(60., 500.)}, noise);
  const signals::Record& record = planned.records.front().record;
  EXPECT_NEAR(rms(record.channel(channel::base_moment)) / noise.moment_n_m, 1., 0.02);
  EXPECT_NEAR(rms(record.channel(channel::base_acceleration)) / noise.acceleration_m_s2, 1., 0.02);
}

TEST(PlannedRecords, RefusesADatasetThatMovesNothing) {
  signals::Dataset quiet = test::rig_dataset(planned_rig);
  quiet.records.erase(quiet.records.begin() + 1, quiet.records.end());
  try {
    inputs_of(test::nominal_of(planned_rig, false), quiet);
    FAIL();
  } catch (const signals::UserError& error) {
    EXPECT_THAT(error.what(), HasSubstr("excitation \"base\" or \"wind\""));
  }
}

TEST(PlannedMenu, ALadderHasTheLinesOfTheStrongestRecordAtFourLevels) {
  const auto added =
      added_inputs("level_ladder", test::nominal_of(planned_rig, false), rig_inputs(false));
  ASSERT_TRUE(added);
  ASSERT_EQ(added->size(), 4u);
  const double strongest = rms(rig_inputs(false).back().acceleration);
  const double levels[] = {0.25, 0.5, 1., 2.};
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(rms((*added)[i].acceleration), levels[i] * strongest, 1e-9);
}

TEST(PlannedMenu, AnotherRateKeepsTheMotion) {
  const auto added =
      added_inputs("other_sampling_rate", test::nominal_of(planned_rig, false), rig_inputs(false));
  const PlannedInput before = rig_inputs(false).back(), after = added->front();
  EXPECT_EQ(after.sampling_rate_hz, 1000.);
  EXPECT_EQ(after.period_samples, 1024u);
  for (std::size_t i = 0; i < before.n_samples; ++i)
    EXPECT_NEAR(after.acceleration[2 * i], before.acceleration[i], 1e-9);
}

TEST(PlannedMenu, PredictsOnlyWhatTheSimulationKnows) {
  const NominalModel still = test::nominal_of(planned_rig, false),
                     windy = test::nominal_of(planned_rig, true);
  const std::vector<PlannedInput> inputs = rig_inputs(true);
  for (const char* entry : {"wind_ladder", "steady_wind"}) {
    EXPECT_FALSE(added_inputs(entry, still, inputs)) << entry;
    EXPECT_TRUE(added_inputs(entry, windy, inputs)) << entry;
  }
  for (const char* entry :
       {"added_mass", "tilt", "clamped_stage", "magnet_removed", "rotate_sensor"})
    EXPECT_FALSE(added_inputs(entry, windy, inputs)) << entry;
  std::size_t n_simulated = 0;
  for (const MenuEntry& entry : experiment_menu())
    if (added_inputs(entry.name, windy, inputs)) ++n_simulated;
  EXPECT_EQ(n_simulated, 6u);
}

}  // namespace
}  // namespace vibrissa::diagnosis
