#include "trial/generator/record_set.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "trial/generator/detection_limit.h"
#include "trial/generator/trial_case.h"
#include "trial/generator/unexplained_change.h"

namespace vibrissa::trial {
namespace {

using signals::DatasetRecord;

/// Records of a sensor without an effect that comes with this set.
signals::Dataset records_with(RecordSet set) {
  return records_of(draw_case(3, 2, Physics::modes, {.set = set}));
}

bool holds(const signals::Dataset& records, const std::function<bool(const DatasetRecord&)>& what) {
  return std::any_of(records.records.begin(), records.records.end(), what);
}

bool is_at_rest(const DatasetRecord& entry) {
  return !entry.excitation.base && !entry.excitation.wind;
}
bool is_windy(const DatasetRecord& entry) {
  return entry.excitation.wind;
}
bool has_probe(const DatasetRecord& entry) {
  return entry.record.has(signals::channel::wind_speed);
}

TEST(RecordSet, CompleteHoldsAll) {
  const signals::Dataset records = records_with(RecordSet::complete);
  EXPECT_EQ(records.records.size(), 10u);
  EXPECT_TRUE(holds(records, is_at_rest) && holds(records, is_windy));
  EXPECT_TRUE(std::all_of(records.records.begin(), records.records.end(), has_probe));
}

TEST(RecordSet, BaseOnlyHasNoWindAndNoRest) {
  const signals::Dataset records = records_with(RecordSet::base_only);
  EXPECT_GE(records.records.size(), 3u);
  EXPECT_FALSE(holds(records, is_windy) || holds(records, is_at_rest) || holds(records, has_probe));
}

TEST(RecordSet, TwoFilesAreTwentySecondsOfRandomVibration) {
  const signals::Dataset records = records_with(RecordSet::two_files);
  ASSERT_EQ(records.records.size(), 1u);
  const DatasetRecord& only = records.records.front();
  EXPECT_DOUBLE_EQ(only.record.duration_s(), 20.);
  EXPECT_EQ(only.period_samples, 0u);
  EXPECT_TRUE(only.excitation.base && !only.excitation.wind && !has_probe(only));
  const signals::Dataset simulated =
      simulated_records(3, draw_form(structure_of({}), 0., 1), RecordSet::two_files);
  ASSERT_EQ(simulated.records.size(), 1u);
  EXPECT_DOUBLE_EQ(simulated.records.front().record.duration_s(), 20.);
}

TEST(RecordSet, NoRestLacksTheRestAlone) {
  const signals::Dataset records = records_with(RecordSet::no_rest);
  EXPECT_EQ(records.records.size(), 9u);
  EXPECT_FALSE(holds(records, is_at_rest));
}

TEST(RecordSet, OneLevelIsOneLevel) {
  const signals::Dataset records = records_with(RecordSet::one_level);
  std::vector<double> levels;
  for (const DatasetRecord& entry : records.records) {
    if (!entry.excitation.base) continue;
    double power = 0.;
    for (const double a : entry.record.channel(signals::channel::base_acceleration))
      power += a * a / static_cast<double>(entry.record.n_samples());
    levels.push_back(std::sqrt(power));
  }
  ASSERT_GE(levels.size(), 4u);
  const auto [low, high] = std::minmax_element(levels.begin(), levels.end());
  EXPECT_LT(*high / *low, 1.1);
}

TEST(RecordSet, WithoutAChannelTheWindBlowsUnmeasured) {
  const signals::Dataset records = records_with(RecordSet::no_wind_channel);
  EXPECT_TRUE(holds(records, is_windy));
  EXPECT_FALSE(holds(records, has_probe));
  for (const auto& [name, further] :
       further_records_of(draw_case(3, 2, Physics::modes, {.set = RecordSet::no_wind_channel})))
    EXPECT_FALSE(holds(further, has_probe)) << name;
}

TEST(RecordSet, TenTimesTheNoiseIsThat) {
  const auto noise = [](const signals::Dataset& records) {
    double power = 0.;
    for (const DatasetRecord& entry : records.records)
      if (is_at_rest(entry))
        for (const double m : entry.record.channel(signals::channel::base_moment)) power += m * m;
    return std::sqrt(power);
  };
  EXPECT_NEAR(
      noise(records_with(RecordSet::ten_times_noise)) / noise(records_with(RecordSet::complete)),
      10., 0.5);
}

TEST(RecordSet, ABenchWithoutAFanDoesNoExperimentWithWind) {
  for (const RecordSet set : {RecordSet::base_only, RecordSet::two_files})
    for (const FurtherExperiment& experiment : further_experiments(set))
      for (const Take& take : experiment.takes) EXPECT_EQ(take.wind_mean, 0.) << experiment.name;
  EXPECT_EQ(further_experiments(RecordSet::complete).size(), 5u);
}

TEST(RecordSet, AWrongLogIsWrongInEverySet) {
  constexpr std::size_t number = 17;
  ASSERT_EQ(class_of(number), CaseClass::wrong_metadata);
  for (const RecordSet set : record_sets()) {
    if (set == RecordSet::two_files) continue;
    for (const std::size_t turn : {number, number + 20}) {
      const signals::Dataset records = records_of(draw_case(3, turn, Physics::modes, {.set = set}));
      EXPECT_TRUE(holds(records, [](const DatasetRecord& entry) {
        return entry.period_samples == 1500 ||
               (entry.excitation.wind && entry.name.starts_with("base_"));
      })) << to_string(set);
    }
  }
}

TEST(RecordSet, DetectionLimitsRiseWhereRecordsAreMissing) {
  const auto limit = [](RecordSet set) {
    World world;
    world.joint.scale = usual_turn;
    world.moment_noise = 1e-6;
    world.acceleration_noise = 0.04;
    return detection_limit(
        LikelihoodRatio(world, {.takes = takes_of(set), .has_wind_channel = has_wind_channel(set)}),
        find_unknown("flow_lag"), 1., 0.5);
  };
  const auto complete = limit(RecordSet::complete), unmeasured = limit(RecordSet::no_wind_channel);
  ASSERT_TRUE(complete);
  EXPECT_FALSE(limit(RecordSet::base_only)) << "no wind shows a lag of the wind";
  EXPECT_FALSE(unmeasured) << *unmeasured << " so does no wind of an unknown spectrum";
}

}  // namespace
}  // namespace vibrissa::trial
