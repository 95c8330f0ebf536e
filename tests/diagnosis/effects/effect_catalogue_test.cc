#include <gmock/gmock.h>

#include <fstream>
#include <set>
#include <sstream>

#include "diagnosis/model/effect.h"
#include "diagnosis/prediction/chain_simulation.h"
#include "signals/base/error.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

/// The ids of docs/effects.md, without sample_repeat, which is detected by its repeated samples.
const std::set<std::string> ids_of_effects_md{"stiffness",
                                              "damping",
                                              "mass",
                                              "hardening",
                                              "viscoelastic",
                                              "softening_history",
                                              "temperature_drift",
                                              "extra_mode",
                                              "base_compliance",
                                              "mount_compliance",
                                              "stage_rocking",
                                              "joint_friction",
                                              "backlash",
                                              "relative_drag",
                                              "drag_error",
                                              "flow_lag",
                                              "vortex_shedding",
                                              "turbulence",
                                              "reference_gain",
                                              "reference_noise",
                                              "reference_highpass",
                                              "cross_axis",
                                              "sensor_gain",
                                              "sensor_nonlinearity",
                                              "coil_feedthrough",
                                              "sensor_drift",
                                              "hum",
                                              "delay",
                                              "sensor_lowpass",
                                              "clock_drift",
                                              "sample_repeat"};

/// A record with base motion, one with wind and one with both, all with a transverse acceleration
/// and an accelerometer with sample-and-hold repeats.
Experiment experiment_of_all_kinds() {
  const test::OneModeRig rig = test::noisy_rig();
  signals::Dataset dataset = test::rig_dataset(rig, {.wind = true});
  dataset.records.back().split = signals::Split::fit;
  for (signals::DatasetRecord& entry : dataset.records) {
    const auto a = entry.record.channel(signals::channel::base_acceleration);
    std::vector<double> transverse(a.rbegin(), a.rend());
    std::vector<double> repeated(a.begin(), a.end());
    for (std::size_t i = 5; i < repeated.size(); i += 5) repeated[i] = repeated[i - 1];
    entry.record.set_channel(signals::channel::cross_acceleration, std::move(transverse));
    entry.record.set_channel(signals::channel::base_acceleration, std::move(repeated));
  }
  NominalModel nominal = test::nominal_of(rig, true);
  nominal.modes.push_back({.frequency_rad_s = 1200.,
                           .damping_ratio = 0.03,
                           .base_gain = -1e-5,
                           .base_rate = -2e-7,
                           .wind_gain = 2e-6,
                           .wind_rate = 1e-8});
  nominal.base_direct = -3e-6;
  return prepare_experiment(nominal, dataset, signals::Split::fit, InputNoise::reduced);
}

class EffectOfTheCatalogue : public testing::TestWithParam<std::string> {};

TEST_P(EffectOfTheCatalogue, ReproducesTheNominalOutputAtItsNeutralValues) {
  static const Experiment experiment = experiment_of_all_kinds();
  const Effect& effect = find_effect(GetParam());
  const Chain nominal{.structure = experiment.nominal};
  Chain extended = nominal;
  std::vector<double> neutral;
  for (const Parameter& parameter : effect.parameters) neutral.push_back(parameter.neutral);
  effect.extend(extended, neutral, experiment.scales);
  EXPECT_EQ(extended.reference_variance, 0.);
  for (const PreparedRecord& record : experiment.records) {
    const Prediction expected = simulate(nominal, record), found = simulate(extended, record);
    double scale = 0.;
    for (const Complex& m : expected.mean) scale = std::max(scale, std::abs(m));
    for (std::size_t b = 0; b < found.mean.size(); ++b) {
      ASSERT_LE(std::abs(found.mean[b] - expected.mean[b]), 1e-12 * scale)
          << record.name << " bin " << b;
      ASSERT_EQ(found.process_noise[b], 0.) << record.name << " bin " << b;
    }
  }
}

TEST_P(EffectOfTheCatalogue, ChangesTheOutputAtEachOfItsStarts) {
  static const Experiment experiment = experiment_of_all_kinds();
  const Effect& effect = find_effect(GetParam());
  const Chain nominal{.structure = experiment.nominal};
  ASSERT_FALSE(effect.starts.empty());
  for (const std::vector<double>& start : effect.starts) {
    Chain extended = nominal;
    effect.extend(extended, start, experiment.scales);
    double change = extended.reference_variance;
    for (const PreparedRecord& record : experiment.records) {
      const Prediction expected = simulate(nominal, record), found = simulate(extended, record);
      const std::vector<double> own = own_noise(found);
      for (std::size_t b = 0; b < found.mean.size(); ++b)
        change += std::abs(found.mean[b] - expected.mean[b]) + own[b];
    }
    EXPECT_GT(change, 0.);
    EXPECT_TRUE(std::isfinite(change));
  }
}

TEST_P(EffectOfTheCatalogue, StartsWithinTheBoundsOfItsPriors) {
  const Effect& effect = find_effect(GetParam());
  for (const std::vector<double>& start : effect.starts) {
    ASSERT_EQ(start.size(), effect.parameters.size());
    for (std::size_t i = 0; i < start.size(); ++i) {
      const Parameter& parameter = effect.parameters[i];
      EXPECT_GE(parameter.coordinate(start[i]), parameter.prior.low) << parameter.name;
      EXPECT_LE(parameter.coordinate(start[i]), parameter.prior.high) << parameter.name;
    }
  }
}

TEST_P(EffectOfTheCatalogue, SaysWhatItIs) {
  const Effect& effect = find_effect(GetParam());
  EXPECT_FALSE(effect.source.empty());
  EXPECT_FALSE(to_string(effect.link).empty());
  for (const Parameter& parameter : effect.parameters) {
    EXPECT_FALSE(parameter.name.empty());
    EXPECT_FALSE(parameter.unit.empty());
    // Calibrations show their ratio alone.
    const bool is_shown = !effect.calibration || parameter.name == "ratio";
    EXPECT_EQ(parameter.relative_to.empty(), parameter.unit != "1" || !is_shown)
        << effect.id << " " << parameter.name;
    EXPECT_LT(parameter.prior.low, parameter.prior.high);
  }
}

/// The entry has the equation (an indented line) and what distinguishes the effect.
TEST_P(EffectOfTheCatalogue, HasAnEntryInThePage) {
  std::ifstream file(std::string(VIBRISSA_SOURCE_DIR) + "/docs/effects.md");
  std::ostringstream page;
  page << file.rdbuf();
  const std::string text = page.str();
  const auto begin = text.find("### " + GetParam() + "\n");
  ASSERT_NE(begin, std::string::npos);
  const std::string entry = text.substr(begin, text.find("\n## ", begin) - begin);
  const std::string own = entry.substr(0, entry.find("\n### ", 1));
  for (const char* const part : {"\n    ", "* Confused with: ", "* Source: "})
    EXPECT_THAT(own, testing::HasSubstr(part));
}

std::vector<std::string> ids() {
  std::vector<std::string> out;
  for (const Effect& effect : effect_catalogue()) out.push_back(effect.id);
  return out;
}

INSTANTIATE_TEST_SUITE_P(All, EffectOfTheCatalogue, testing::ValuesIn(ids()),
                         [](const auto& info) { return info.param; });

TEST(EffectCatalogue, HoldsEachIdOfTheListOnce) {
  const std::vector<std::string> found = ids();
  const std::set<std::string> unique(found.begin(), found.end());
  EXPECT_EQ(unique.size(), found.size());
  EXPECT_THAT(unique, testing::IsSupersetOf(ids_of_effects_md));
}

TEST(EffectCatalogue, TellsWhatActsLineByLineFromWhatDoesNot) {
  for (const char* id : {"delay", "stiffness", "viscoelastic", "hum"})
    EXPECT_FALSE(is_nonlinear(find_effect(id))) << id;
  for (const char* id : {"hardening", "joint_friction", "sensor_nonlinearity", "sample_repeat"})
    EXPECT_TRUE(is_nonlinear(find_effect(id))) << id;
}

TEST(EffectCatalogue, ListsTheKnownIdsForAnUnknownOne) {
  try {
    find_effect("stifness");
    FAIL();
  } catch (const signals::UserError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'stiffness'"));
  }
}

TEST(Hardening, StartsWithTheStiffnessOfStatisticalLinearisation) {
  // E[y moment(y)] / E[y^2] of normal motion whose peak, three deviations, is the scale.
  const Effect& hardening = find_effect("hardening");
  const Scales scales{.joint_moment_n_m = 2e-4};
  const double deviation = scales.joint_moment_n_m / 3.;
  for (const double cubic : {-0.15, 0.2, 1.5}) {
    Chain chain;
    hardening.extend(chain, std::vector{cubic}, scales);
    const auto law = chain.joint.front()(Lanes::Zero());
    double work = 0., square = 0.;
    for (double z = -6.; z <= 6.; z += 0.01) {
      const double y = deviation * z, density = std::exp(-0.5 * z * z);
      const Lanes at = Lanes::Constant(y), none = Lanes::Zero();
      work += density * y * (y + law->moment(at, none, none, 1e-3, false)(0));
      square += density * y * y;
    }
    EXPECT_NEAR(hardening.equivalent_stiffness(std::vector{cubic}), work / square, 1e-3) << cubic;
  }
}

}  // namespace
}  // namespace vibrissa::diagnosis
