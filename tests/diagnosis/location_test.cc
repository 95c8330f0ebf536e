#include "diagnosis/location.h"

#include <gmock/gmock.h>

#include "one_mode_rig.h"

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

TEST(Location, FindsNothingWhereThereIsNothing) {
  for (unsigned seed = 1; seed <= 20; seed += 3) {
    const Location location = located(test::noisy_rig(), {.wind = true, .seed = 100 * seed});
    EXPECT_THAT(location.channels, IsEmpty()) << seed;
    EXPECT_THAT(location.bands_hz, IsEmpty()) << seed;
    EXPECT_EQ(location.harmonics, Harmonics::none) << seed;
    EXPECT_FALSE(location.varies_in_time) << seed;
    EXPECT_FALSE(location.present_at_rest) << seed;
    EXPECT_GT(location.p_value, 0.01) << seed;
    EXPECT_EQ(location_sentence(location), "No gap beyond noise.");
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
  EXPECT_NEAR(*location.level_exponent, 0., 0.15);
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
  EXPECT_GT(*location.level_exponent, 1.);
}

TEST(Location, TellsNoLevelExponentFromOneLevelOrWithoutAGap) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 0.9;
  EXPECT_FALSE(located(rig, {.low_level = 4., .high_level = 4.}).level_exponent);
  EXPECT_FALSE(located(test::noisy_rig()).level_exponent);
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
  signals::Dataset dataset = test::rig_dataset(test::noisy_rig());
  for (signals::DatasetRecord& entry : dataset.records) {
    const auto m = entry.record.channel(signals::channel::base_moment);
    std::vector<double> drifting(m.begin(), m.end());
    for (std::size_t i = 0; i < drifting.size(); ++i)
      drifting[i] *= 1. + 0.2 * static_cast<double>(i) / static_cast<double>(drifting.size());
    entry.record.set_channel(signals::channel::base_moment, std::move(drifting));
  }
  EXPECT_TRUE(locate_gap(prepare_experiment(test::nominal_of(test::OneModeRig{}, false), dataset,
                                            signals::Split::fit, InputNoise::reduced))
                  .varies_in_time);
}

TEST(Location, SumsProbabilitiesOfLinksOverCandidates) {
  SearchResult result;
  result.candidates = {{.name = "delay+stiffness", .fit = 0, .retunes = {}, .probability = 0.5},
                       {.name = "stiffness", .fit = 0, .retunes = {}, .probability = 0.35},
                       {.name = "hum", .fit = 0, .retunes = {}, .probability = 0.05},
                       {.name = "none", .fit = 0, .retunes = {}, .probability = 0.1}};
  EXPECT_THAT(likely_links(result), ElementsAre("structure", "clock"));
}

}  // namespace
}  // namespace vibrissa::diagnosis
