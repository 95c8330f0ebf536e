#include "diagnosis/search/search.h"

#include <gmock/gmock.h>

#include <cmath>

#include "diagnosis/diagnosis.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

Experiment experiment_of(const test::OneModeRig& rig, const test::RigDatasetOptions& options = {}) {
  return prepare_experiment(test::nominal_of(test::OneModeRig{}, options.wind),
                            test::rig_dataset(rig, options), signals::Split::fit,
                            InputNoise::reduced);
}

TEST(Search, AnswersAlikeWithAnyNumberOfThreads) {
  test::OneModeRig rig = test::noisy_rig();
  rig.cubic = 3e6;
  const Experiment experiment = experiment_of(rig);
  const SearchResult one = search(experiment, {.max_effects = 2, .n_threads = 1});
  const SearchResult three = search(experiment, {.max_effects = 2, .n_threads = 3});
  ASSERT_EQ(one.candidates.size(), three.candidates.size());
  for (std::size_t i = 0; i < one.candidates.size(); ++i) {
    EXPECT_EQ(one.candidates[i].name, three.candidates[i].name);
    EXPECT_EQ(one.candidates[i].log_posterior, three.candidates[i].log_posterior);
  }
}

TEST(Search, ASensorThatIsALittleOffEverywhereIsAsBuilt) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 0.975;
  rig.loss = 1.1;
  rig.moment_mass *= 1.02;
  rig.drag *= 0.94;
  EXPECT_EQ(search(experiment_of(rig, {.wind = true})).candidates.front().name, "none");
}

double fitted_ratio(const SearchResult& result, const std::string& calibration) {
  const HypothesisFit& fit = result.fits[result.candidates.front().fit];
  return std::exp(fit.x(static_cast<Eigen::Index>(*fit.index(calibration, 0))));
}

TEST(Search, FollowsACalibrationThatIsFarOff) {
  test::OneModeRig rig = test::noisy_rig();
  rig.drag *= 1.5;
  const SearchResult result = search(experiment_of(rig, {.wind = true}));
  EXPECT_EQ(result.candidates.front().name, "none");
  EXPECT_NEAR(fitted_ratio(result, "drag_error"), 1.5, 0.02);
}

TEST(Search, FollowsAResonanceThatIsFarOff) {
  for (const double stiffness : {0.55, 1.3}) {
    test::OneModeRig rig = test::noisy_rig();
    rig.stiffness = stiffness;
    const SearchResult result = search(experiment_of(rig), {.max_effects = 1});
    EXPECT_NEAR(fitted_ratio(result, "stiffness"), stiffness, 0.01 * stiffness);
  }
}

TEST(Search, FindsAWeakNarrowModeWhereverItLies) {
  // A thirtieth of the weakest start of a fit, but still ten times its detection limit.
  for (const double hz : {57., 71.5, 96.}) {
    test::OneModeRig rig = test::noisy_rig();
    rig.extra_hz = hz;
    rig.extra_residue = 1.5e-3;
    const SearchResult result = search(experiment_of(rig), {.max_effects = 1});
    EXPECT_EQ(result.candidates.front().name, "extra_mode") << hz;
    const HypothesisFit& fit = result.fits[result.candidates.front().fit];
    const auto index = fit.index("extra_mode", 0);
    ASSERT_TRUE(index.has_value()) << hz;
    EXPECT_NEAR(std::exp(fit.x(static_cast<Eigen::Index>(*index))), hz, 0.01 * hz);
  }
}

TEST(Search, ASensorThatIsMerelyOffIsNoAnswerWhereMuchIsLeft) {
  test::OneModeRig rig = test::noisy_rig();
  rig.cubic = 1e7;
  std::vector<std::string> all;
  for (const Effect& effect : effect_catalogue())
    if (!effect.calibration) all.push_back(effect.id);
  const UpdatedModel simulation(test::nominal_of(test::OneModeRig{}, false));
  EXPECT_EQ(diagnose(simulation, test::rig_dataset(rig), {.search = {.left_out = all}}).verdict,
            outside_catalogue);
}

TEST(Search, NamesAPairOfStrongEffects) {
  test::OneModeRig rig = test::noisy_rig();
  rig.delay_s = 1e-3;
  rig.cubic = 1e7;
  EXPECT_EQ(search(experiment_of(rig)).candidates.front().name, "delay+hardening");
}

TEST(Search, NamesAToneThatIsLoud) {
  // Its leakage is above the noise in all bins.
  test::OneModeRig rig = test::noisy_rig();
  rig.hum = 1e-4;
  const SearchResult result = search(experiment_of(rig));
  EXPECT_EQ(result.candidates.front().name, "hum");
  const HypothesisFit& fit = result.fits[result.candidates.front().fit];
  const auto at = [&](std::size_t parameter) {
    return fit.x(static_cast<Eigen::Index>(*fit.index("hum", parameter)));
  };
  EXPECT_NEAR(std::exp(at(0)), rig.hum, 0.5 * rig.hum);
  EXPECT_NEAR(at(1), rig.hum_hz, 1e-3);
}

TEST(Search, EffectsThatAreLeftOutAreNotNamed) {
  test::OneModeRig rig = test::noisy_rig();
  rig.delay_s = 1e-3;
  const SearchResult result = search(experiment_of(rig), {.left_out = {"delay"}});
  for (const Candidate& candidate : result.candidates)
    EXPECT_THAT(candidate.name, testing::Not(testing::HasSubstr("delay")));
}

}  // namespace
}  // namespace vibrissa::diagnosis
