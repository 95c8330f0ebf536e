#include "diagnosis/planning/next_experiment.h"

#include <gmock/gmock.h>

#include "signals/base/error.h"

namespace vibrissa::diagnosis {
namespace {

using testing::Contains;
using testing::IsSupersetOf;

std::vector<Candidate> candidates(std::vector<std::pair<std::string, double>> odds) {
  std::vector<Candidate> out;
  for (const auto& [name, probability] : odds)
    out.push_back({.name = name, .fit = 0, .calibrations = {}, .probability = probability});
  return out;
}

TEST(NextExperiment, MenuNamesEffectsOfTheCatalogueOnly) {
  EXPECT_EQ(experiment_menu().size(), 11u);
  for (const MenuEntry& entry : experiment_menu())
    for (const auto& [id, shown] : entry.shows) {
      // Detected by the share of repeated samples (docs/effects.md).
      if (id == "sample_repeat") continue;
      EXPECT_NO_THROW(find_effect(id)) << entry.name;
    }
}

TEST(NextExperiment, TellsDelayFromLowpassByAWiderBand) {
  const NextExperiment next = next_experiment(candidates({{"delay", 0.5}, {"sensor_lowpass", 0.5}}),
                                              {"delay", "sensor_lowpass"}, {});
  EXPECT_EQ(next.name, "wide_band");
  EXPECT_NEAR(next.split_probability, 0.5, 1e-12);
  EXPECT_THAT(next.would_separate, IsSupersetOf({"delay", "sensor_lowpass"}));
}

TEST(NextExperiment, TellsHumFromSheddingByTheWind) {
  const NextExperiment next = next_experiment(candidates({{"hum", 0.6}, {"vortex_shedding", 0.4}}),
                                              {"hum", "vortex_shedding"}, {});
  EXPECT_EQ(next.name, "wind_ladder");
}

TEST(NextExperiment, SplitsAnIndistinguishableSetOfACertainAnswer) {
  const NextExperiment next =
      next_experiment(candidates({{"stiffness", 1.}}), {"stiffness"}, {{"stiffness", "mass"}});
  EXPECT_NE(next.name, "none");
  EXPECT_THAT(next.would_separate, Contains("mass"));
}

TEST(NextExperiment, AsksForWhatTheBenchCanDo) {
  const auto left = candidates({{"delay", 0.5}, {"sensor_lowpass", 0.5}});
  const std::vector<std::string> set{"delay", "sensor_lowpass"};
  EXPECT_EQ(next_experiment(left, set, {}, {"tilt", "other_sampling_rate"}).name,
            "other_sampling_rate");
  EXPECT_EQ(next_experiment(left, set, {}, {"tilt"}).name, "none");
}

TEST(NextExperiment, KnowsTheNamesOfItsMenu) {
  EXPECT_NO_THROW(check_menu_names({"tilt", "wide_band"}));
  try {
    check_menu_names({"wide_bend"});
    FAIL();
  } catch (const signals::UserError& error) {
    EXPECT_THAT(error.what(),
                testing::AllOf(testing::HasSubstr("'wide_bend'"), testing::HasSubstr("wide_band")));
  }
}

TEST(NextExperiment, AsksForNothingWhenNothingIsLeftToSplit) {
  EXPECT_EQ(next_experiment(candidates({{"delay", 1.}}), {"delay"}, {}).name, "none");
}

}  // namespace
}  // namespace vibrissa::diagnosis
