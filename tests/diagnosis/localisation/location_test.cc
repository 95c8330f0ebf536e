#include "diagnosis/localisation/location.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

Location located(const test::OneModeRig& rig, const test::RigDatasetOptions& options = {}) {
  const NominalModel nominal = test::nominal_of(test::OneModeRig{}, options.wind);
  return locate_gap(prepare_experiment(nominal, test::rig_dataset(rig, options),
                                       signals::Split::fit, InputNoise::reduced));
}

/// Records of a sensor whose gain rises by a fifth during every record.
Location drifting_gain() {
  signals::Dataset dataset = test::rig_dataset(test::noisy_rig());
  for (signals::DatasetRecord& entry : dataset.records) {
    const auto m = entry.record.channel(signals::channel::base_moment);
    std::vector<double> drifting(m.begin(), m.end());
    for (std::size_t i = 0; i < drifting.size(); ++i)
      drifting[i] *= 1. + 0.2 * static_cast<double>(i) / static_cast<double>(drifting.size());
    entry.record.set_channel(signals::channel::base_moment, std::move(drifting));
  }
  return locate_gap(prepare_experiment(test::nominal_of(test::OneModeRig{}, false), dataset,
                                       signals::Split::fit, InputNoise::reduced));
}

TEST(Location, FindsNothingWhereThereIsNothing) {
  for (unsigned seed = 1; seed <= 20; seed += 3) {
    const Location location = located(test::noisy_rig(), {.wind = true, .seed = 100 * seed});
    EXPECT_THAT(location.channels, IsEmpty()) << seed;
    EXPECT_THAT(location.bands_hz, IsEmpty()) << seed;
    EXPECT_EQ(location.harmonics, Harmonics::none) << seed;
    EXPECT_FALSE(location.varies_in_time) << seed;
    EXPECT_FALSE(location.present_at_rest) << seed;
    EXPECT_GT(location.p_value, 0.01) << seed;
    EXPECT_EQ(location_sentence(location), "No gap larger than noise.");
  }
}

TEST(Location, PlacesASofterWhiskerAtItsModeUnderBaseMotionWithoutDistortion) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 0.9;
  const Location location = located(rig);
  EXPECT_THAT(location.channels, ElementsAre("base"));
  EXPECT_LT(location.p_value, 1e-9);
  EXPECT_EQ(location.mode, 1u);
  ASSERT_THAT(location.bands_hz, Not(IsEmpty()));
  EXPECT_LT(location.bands_hz.front()[0], 33.);
  EXPECT_GT(location.bands_hz.back()[1], 35.);
  ASSERT_TRUE(location.level_exponent);
  EXPECT_NEAR(location.level_exponent->value, 0., 0.15);
  EXPECT_EQ(location.harmonics, Harmonics::none);
  EXPECT_FALSE(location.varies_in_time);
}

TEST(Location, FindsOddDistortionThatGrowsWithTheSquareOfTheLevel) {
  test::OneModeRig rig = test::noisy_rig();
  rig.cubic = 4e5;
  const Location location = located(rig, {.low_level = 2., .high_level = 4.});
  EXPECT_THAT(location.channels, Contains("base"));
  EXPECT_EQ(location.harmonics, Harmonics::odd);
  ASSERT_TRUE(location.level_exponent);
  EXPECT_GT(location.level_exponent->value, 1.);
}

TEST(Location, TellsNoLevelExponentFromOneLevelOrWithoutAGap) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 0.9;
  EXPECT_FALSE(located(rig, {.low_level = 4., .high_level = 4.}).level_exponent);
  EXPECT_FALSE(located(test::noisy_rig()).level_exponent);
}

double largest_excess(const LevelGap& level) {
  double largest = 0.;
  for (const BandGap& band : level.bands) largest = std::max(largest, band.excess);
  return largest;
}

// The power of a linear response grows with the level squared, that of a cubic spring's moment with
// its sixth power.
TEST(Location, MapsTheGapByLevel) {
  test::OneModeRig softer = test::noisy_rig(), hardening = test::noisy_rig();
  softer.stiffness = 0.9;
  hardening.cubic = 4e5;
  const auto linear = located(softer, {.low_level = 2., .high_level = 4.}).by_level;
  const auto cubic = located(hardening, {.low_level = 2., .high_level = 4.}).by_level;
  ASSERT_EQ(linear.size(), 2U);
  ASSERT_EQ(cubic.size(), 2U);
  EXPECT_NEAR(linear[1].level_m_s2 / linear[0].level_m_s2, 2., 0.05);
  EXPECT_NEAR(largest_excess(linear[1]) / largest_excess(linear[0]), 4., 1.);
  EXPECT_GT(largest_excess(cubic[1]) / largest_excess(cubic[0]), 16.);
  EXPECT_THAT(located(softer, {.low_level = 4., .high_level = 4.}).by_level, IsEmpty());
}

TEST(Location, FollowsTheGapAlongEachRecord) {
  const auto nothing = located(test::noisy_rig()).in_time;
  ASSERT_THAT(nothing, Not(IsEmpty()));
  for (const GapInTime& record : nothing) {
    const auto [least, most] = std::minmax_element(record.excess.begin(), record.excess.end());
    EXPECT_GT(*least, 0.4) << record.record;
    EXPECT_LT(*most, 2.) << record.record;
    EXPECT_LT(record.time_s.front(), record.time_s.back());
  }
  for (const GapInTime& record : drifting_gain().in_time)
    EXPECT_GT(record.excess.back(), 5. * record.excess.front()) << record.record;
}

TEST(Location, TellsNoModeWithoutAGap) {
  EXPECT_FALSE(located(test::noisy_rig()).mode);
}

TEST(Location, FindsAWeakHumOnlyAtRest) {
  test::OneModeRig rig = test::noisy_rig();
  rig.hum = 3e-6;
  const Location location = located(rig);
  EXPECT_TRUE(location.present_at_rest);
  EXPECT_THAT(location.channels, ElementsAre("rest"));
}

TEST(Location, FindsTheWrongDragUnderWindAlone) {
  test::OneModeRig rig = test::noisy_rig();
  rig.drag *= 1.2;
  EXPECT_THAT(located(rig, {.wind = true}).channels, ElementsAre("wind"));
}

TEST(Location, NoticesAGainThatDriftsWithinARecord) {
  EXPECT_TRUE(drifting_gain().varies_in_time);
}

TEST(Location, SumsProbabilitiesOfLinksOverCandidates) {
  SearchResult result;
  result.candidates = {
      {.name = "delay+stiffness", .fit = 0, .calibrations = {}, .probability = 0.5},
      {.name = "stiffness", .fit = 0, .calibrations = {}, .probability = 0.35},
      {.name = "hum", .fit = 0, .calibrations = {}, .probability = 0.05},
      {.name = "none", .fit = 0, .calibrations = {}, .probability = 0.1}};
  EXPECT_THAT(likely_links(result), ElementsAre("structure", "clock"));
}

TEST(LikelyLinks, AreNoneWhereNothingIsTheLikeliest) {
  SearchResult result;
  result.candidates = {{.name = "none", .fit = 0, .calibrations = {}, .probability = 0.5},
                       {.name = "flow_lag", .fit = 0, .calibrations = {}, .probability = 0.3},
                       {.name = "turbulence", .fit = 0, .calibrations = {}, .probability = 0.2}};
  EXPECT_TRUE(likely_links(result).empty());
}

}  // namespace
}  // namespace vibrissa::diagnosis
