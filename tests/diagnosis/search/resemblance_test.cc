#include "diagnosis/search/resemblance.h"

#include <gtest/gtest.h>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

class ResemblanceTest : public testing::Test {
 protected:
  void measure(const test::OneModeRig& rig, const double rise = 0.) {
    prepare(rig, test::rig_dataset(rig, {}), rise);
  }
  /// Records without periods, which begin while the whisker moves.
  void measure_without_periods(const test::OneModeRig& rig) {
    signals::Dataset records = test::rig_dataset(rig, {.quiet = false});
    for (signals::DatasetRecord& entry : records.records) entry.period_samples = 0;
    prepare(rig, std::move(records), 0.);
  }
  void prepare(const test::OneModeRig& rig, signals::Dataset records, const double rise) {
    for (signals::DatasetRecord& entry : records.records) {
      const auto moment = entry.record.channel(signals::channel::base_moment);
      std::vector<double> drifted(moment.begin(), moment.end());
      for (std::size_t i = 0; i < drifted.size(); ++i)
        drifted[i] += rise * static_cast<double>(i) / static_cast<double>(drifted.size());
      entry.record.set_channel(signals::channel::base_moment, std::move(drifted));
    }
    experiment_ = prepare_experiment(test::nominal_of(rig, false), records, signals::Split::fit,
                                     InputNoise::reduced);
    fit_ = fit_hypothesis(experiment_, Hypothesis{});
  }
  Resemblance of(const std::string& effect, const std::vector<std::vector<double>>& tried) const {
    return FitResidual(experiment_, fit_).resemblance(find_effect(effect), tried);
  }

  Experiment experiment_;
  HypothesisFit fit_;
};

TEST_F(ResemblanceTest, TellsPlaceAndSizeOfAModeThatIsThirtyTimesWeakerThanWhatIsTried) {
  test::OneModeRig rig = test::noisy_rig();
  rig.extra_hz = 70.;
  rig.extra_residue = 1.5e-3;
  measure(rig);
  const Resemblance found =
      of("extra_mode", {{60., 0.02, 0.05}, {70., 0.02, 0.05}, {80., 0.02, 0.05}});
  EXPECT_GT(found.gain, 50.);
  ASSERT_FALSE(found.values.empty());
  EXPECT_EQ(found.values[0], 70.);
  EXPECT_NEAR(std::abs(found.values[2]), 1.5e-3, 3e-4);
}

TEST_F(ResemblanceTest, OfNoiseAloneIsThatOfChance) {
  measure(test::noisy_rig());
  // Chi-square of one degree: beyond 16 once in 16 000.
  for (const double hz : {50., 60., 70., 80., 90., 120.})
    EXPECT_LT(of("extra_mode", {{hz, 0.02, 0.05}}).gain, 16.) << hz;
}

TEST_F(ResemblanceTest, OfAnotherEffectIsSmallWhereTheStartOfARecordIsUnknown) {
  test::OneModeRig rig = test::noisy_rig();
  rig.damping_ratio = 0.02;
  rig.cubic = 4e5;
  measure_without_periods(rig);
  const auto gain = [&](const char* effect) { return of(effect, find_effect(effect).starts).gain; };
  const double own = gain("hardening");
  for (const char* effect : {"delay", "base_compliance", "clock_drift"})
    EXPECT_LT(gain(effect), 0.5 * own) << effect;
}

TEST_F(ResemblanceTest, TellsPlaceAndSizeOfATone) {
  test::OneModeRig rig = test::noisy_rig();
  rig.hum = 2e-5;
  rig.hum_hz = 50.1;
  measure(rig);
  const Resemblance found = of("hum", {{1e-6, 49.7}, {1e-6, 50.1}, {1e-6, 60.}});
  EXPECT_GT(found.gain, 50.);
  ASSERT_FALSE(found.values.empty());
  EXPECT_EQ(found.values[1], 50.1);
  EXPECT_NEAR(found.values[0], rig.hum, 0.3 * rig.hum);
}

TEST_F(ResemblanceTest, TellsARampThatLooksLikeFlickerNoise) {
  test::OneModeRig rig = test::noisy_rig();
  measure(rig, 2. * rig.moment_noise);
  EXPECT_GT(of("sensor_drift", {{3e-6}}).gain, 20.);
  measure(rig);
  EXPECT_LT(of("sensor_drift", {{3e-6}}).gain, 6.);
}

TEST_F(ResemblanceTest, HasNoSizeBeyondTheRangeOfTheEffect) {
  test::OneModeRig rig = test::noisy_rig();
  rig.extra_hz = 70.;
  rig.extra_residue = 2.;
  measure(rig);
  const Resemblance found = of("extra_mode", {{70., 0.02, 0.05}});
  EXPECT_GT(found.gain, 50.);
  EXPECT_TRUE(found.values.empty());
}

}  // namespace
}  // namespace vibrissa::diagnosis
