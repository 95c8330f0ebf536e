#include "diagnosis/resonances/resonance_gap.h"

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "diagnosis/model/hypothesis.h"
#include "diagnosis/resonances/resonance_effects.h"
#include "signals/base/error.h"
#include "tests/diagnosis/paper_resonance.h"

namespace vibrissa::diagnosis {
namespace {

using test::paper;
using testing::Contains;
using testing::HasSubstr;
using testing::ThrowsMessage;

const ResonanceExplanation& find(const ResonanceDiagnosis& diagnosis, const std::string& name) {
  for (const ResonanceExplanation& e : diagnosis.explanations)
    if (e.name() == name) return e;
  throw std::runtime_error(name + " is missing");
}

double value(const ResonanceExplanation& explanation, const std::string& name) {
  for (const NeededValue& parameter : explanation.parameters)
    if (parameter.name == name) return parameter.value;
  throw std::runtime_error(name + " is missing");
}

TEST(ResonanceGap, FindsWhatTheReferenceStudysGapTakes) {
  const ResonanceDiagnosis gap = paper();
  EXPECT_NEAR(gap.modal_ratio, 0.711, 5e-4);
  const ResonanceExplanation& stiffness = find(gap, "stiffness");
  EXPECT_NEAR(value(stiffness, "ratio"), 0.711, 5e-4);
  EXPECT_NEAR(value(stiffness, "silicone_modulus_ratio"), 0.64, 5e-3);
  EXPECT_NEAR(value(find(gap, "mass"), "ratio"), 1.406, 5e-4);
  EXPECT_NEAR(value(find(gap, "base_compliance"), "stiffness_ratio"), 2.46, 5e-3);
  EXPECT_TRUE(stiffness.inside_usual_range);
  EXPECT_TRUE(find(gap, "base_compliance").inside_usual_range);
  EXPECT_TRUE(find(gap, "softening_history").inside_usual_range);
  // 1.406 is more than 1.4, and a mount that soft is below 60 Hz.
  for (const char* id : {"mass", "mount_compliance", "temperature_drift", "hardening"})
    EXPECT_FALSE(find(gap, id).inside_usual_range) << id;
  EXPECT_FALSE(find(gap, "joint_friction").possible);
  EXPECT_FALSE(find(gap, "viscoelastic").possible);
}

TEST(ResonanceGap, FirstNamesASofterSiliconeAndAnExperiment) {
  const ResonanceDiagnosis gap = paper();
  EXPECT_EQ(gap.verdict, "stiffness");
  EXPECT_LT(find(gap, "mass").odds, 0.1 * find(gap, "stiffness").odds);
  EXPECT_LT(find(gap, "damping").odds, 1e-6);
  EXPECT_THAT(gap.confidence_set, Contains("base_compliance"));
  EXPECT_NE(gap.next.name, "none");
  EXPECT_THAT(gap.next.would_separate, Contains("stiffness"));
  double sum = 0.;
  for (const ResonanceExplanation& e : gap.explanations) sum += e.odds;
  EXPECT_NEAR(sum, 1., 1e-12);
}

TEST(ResonanceGap, NoMountOfAUsualFrequencyReachesTheReferenceStudysGap) {
  const ResonanceDiagnosis gap = paper();
  const ResonanceExplanation& mount = find(gap, "mount_compliance");
  // b^2 = q (1 + m / (1 - q)) with the largest mass ratio, m = 0.4.
  const double q = std::pow(31.47 / 37.32, 2);
  EXPECT_NEAR(value(mount, "frequency"), 37.32 * std::sqrt(q * (1. + 0.4 / (1. - q))), 1e-6);
  EXPECT_LT(value(mount, "frequency"), 60.);
  EXPECT_THAT(mount.note, HasSubstr("frequency outside its usual range 60 .. 200"));
}

TEST(ResonanceGap, SaysWhichDamperIsLeft) {
  const ResonanceDiagnosis gap = paper();
  const double change = 0.027 / 0.05, r = gap.modal_ratio;
  // zeta = c / (2 sqrt(k m)).
  EXPECT_NEAR(*find(gap, "stiffness").damping_left, change * std::sqrt(r), 1e-9);
  EXPECT_NEAR(*find(gap, "mass").damping_left, change / std::sqrt(r), 1e-9);
  EXPECT_NEAR(*find(gap, "base_compliance").damping_left, change / std::pow(r, 1.5), 1e-9);
}

// The modal ratios were computed by vibrissa modes on cases/flow_sensor.prm with the silicone's
// c1, c2 and c3 times the modulus ratio; the share is twice its sensitivity of the first frequency.
TEST(ResonanceGap, SpringsInSeriesAgreeWithTheFiniteElementModel) {
  const double share = 2. * 0.281164744418498;
  EXPECT_NEAR(squared_frequency_ratio({.joint = 0.6}, share),
              std::pow(31.87775167482111 / 37.37132216881865, 2), 1e-3);
  EXPECT_NEAR(squared_frequency_ratio({.joint = 0.358}, share),
              std::pow(26.38419326294731 / 37.37132216881865, 2), 1e-3);
  // Another measured frequency of that model recovers the modulus used.
  const ResonanceDiagnosis gap =
      explain_resonance_gap({.frequency_hz = 37.37132216881865},
                            {.frequency_hz = 31.87775167482111}, {.joint_share = share});
  EXPECT_NEAR(value(find(gap, "stiffness"), "silicone_modulus_ratio"), 0.6, 1e-3);
}

/// The pole of m s^2 + K(s) k_s / (K(s) + k_s), K = 1 + c s, by Newton's method.
Complex series_pole(double c, double series) {
  Complex s(0., 0.9);
  for (int i = 0; i < 50; ++i) {
    const auto f = [&](Complex at) {
      const Complex k = 1. + c * at;
      return at * at + k * series / (k + series);
    };
    const Complex step = 1e-7;
    s -= f(s) * 2. * step / (f(s + step) - f(s - step));
  }
  return s;
}

TEST(ResonanceGap, ASeriesSpringChangesFrequencyAndDampingAsItsPoleDoes) {
  const double zeta = 0.01, series = 2.46;
  const ModeChange change{.series_compliance = 1. / series};
  const Complex pole = series_pole(2. * zeta, series);
  EXPECT_NEAR(std::sqrt(squared_frequency_ratio(change, 1.)), std::abs(pole), 1e-3);
  EXPECT_NEAR(damping_ratio_factor(change, 1., zeta), -pole.real() / std::abs(pole) / zeta, 3e-3);
}

class MountTest : public testing::TestWithParam<std::array<double, 2>> {};

// Two masses and two springs: the mount's and the first mode's.
TEST_P(MountTest, LowersAndDampsTheFirstModeAsItsMassOnABaseDoes) {
  const auto [frequency, mass] = GetParam();
  const double base = frequency * frequency / mass, zeta = 0.005;
  const ModeChange change{.mount_frequency = frequency, .mount_mass = mass};
  const double m_base = 1. / mass;
  const double c = 2. * zeta, c_base = 2. * mount_damping_ratio * frequency * m_base;
  Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
  a.topRightCorner<2, 2>().setIdentity();
  a.row(2) << -(base + 1.) / m_base, 1. / m_base, -(c_base + c) / m_base, c / m_base;
  a.row(3) << 1., -1., c, -c;
  Complex lowest(0., 1e9);
  for (const Complex& pole : Eigen::Vector4cd(a.eigenvalues()))
    if (pole.imag() > 0. && std::abs(pole) < std::abs(lowest)) lowest = pole;
  EXPECT_NEAR(std::sqrt(squared_frequency_ratio(change, 0.7)), std::abs(lowest), 1e-3);
  EXPECT_NEAR(damping_ratio_factor(change, 0.7, zeta), -lowest.real() / std::abs(lowest) / zeta,
              0.01);
}
INSTANTIATE_TEST_SUITE_P(Mounts, MountTest,
                         testing::Values(std::array{1.3, 0.4}, std::array{2., 0.1},
                                         std::array{4., 0.3}, std::array{0.8, 0.2}));

/// The mode changed by an explanation's values.
std::optional<ModeChange> mode_of(const ResonanceExplanation& explanation,
                                  const std::vector<ResonanceEffect>& known) {
  ModeChange change;
  for (const std::string& id : explanation.effects) {
    const auto effect =
        std::find_if(known.begin(), known.end(), [&](const auto& e) { return e.effect->id == id; });
    if (effect == known.end()) return std::nullopt;
    for (const NeededValue& needed : explanation.parameters) {
      if (needed.effect != id) continue;
      if (needed.name == effect->parameter.name) effect->apply(needed.value, change);
      if (needed.name == "mass_ratio") change.mount_mass = needed.value;
    }
  }
  return change;
}

TEST(ResonanceGap, EveryExplanationBringsTheResonanceThere) {
  for (const double measured_hz : {20., 31.47, 36., 39., 45.}) {
    const ResonanceExample example = paper_gap();
    const ResonanceDiagnosis gap = explain_resonance_gap(
        example.simulated, {.frequency_hz = measured_hz, .damping_ratio = 0.03}, example.model);
    const auto known = resonance_effects(37.32, example.model.silicone_modulus_pa);
    int n = 0;
    for (const ResonanceExplanation& e : gap.explanations) {
      const auto change = mode_of(e, known);
      if (!e.possible || !change || e.effects.empty()) continue;
      EXPECT_NEAR(squared_frequency_ratio(*change, 0.71) / gap.modal_ratio, 1., 1e-9)
          << e.name() << " at " << measured_hz;
      EXPECT_NEAR(*e.damping_left * damping_ratio_factor(*change, 0.71, 0.05), 0.03 / 0.05, 1e-9)
          << e.name();
      ++n;
    }
    EXPECT_GE(n, 20);
  }
}

/// Mean density of the measured parameters over samples of the priors.
struct Sampled {
  std::mt19937_64 random{7};
  std::student_t_distribution<double> student{6.};
  std::uniform_real_distribution<double> uniform{0., 1.};
  const double scale = 0.25 * std::log(2.04 / 0.73), centre = 0.5 * std::log(0.73 / 2.04);

  double modulus() { return std::exp(centre + scale * student(random)); }
  double mass() {
    return std::exp(0.25 * std::log(1.1 / 0.9) * student(random) + 0.5 * std::log(0.99));
  }
  double series() {
    const bool usual = uniform(random) < 0.9;
    const double low = usual ? 1. : 0.5, high = usual ? 20. : 60.;
    return low * std::pow(high / low, uniform(random));
  }
};

template <typename Draw>
double sampled_evidence(const Draw& compliance_times_mass_and_weight) {
  const double y = 2. * std::log(31.47 / 37.32), deviation = 2. * std::sqrt(2.) * 0.01;
  constexpr int n = 2000000;
  double sum = 0.;
  for (int i = 0; i < n; ++i) {
    const auto [inverse, weight] = compliance_times_mass_and_weight();
    const double z = (y + std::log(inverse)) / deviation;
    sum += weight * std::exp(-0.5 * z * z) / (deviation * std::sqrt(2. * std::numbers::pi));
  }
  return sum / n;
}

using Draw = std::array<double, 2>;

TEST(ResonanceGap, OddsOfACombinationAreThoseOfSampledPriors) {
  const ResonanceExample example = paper_gap();
  const ResonanceDiagnosis gap =
      explain_resonance_gap({.frequency_hz = 37.32}, {.frequency_hz = 31.47}, example.model);
  Sampled draw;
  const double one = sampled_evidence([&] { return Draw{0.71 / draw.modulus() + 0.29, 1.}; });
  const double two = sampled_evidence([&] {
    return Draw{(0.71 / draw.modulus() + 0.29) * draw.mass(), 1.};
  });
  const std::size_t n = resonance_effects(37.32, 2.04e6).size();
  const double prior = std::exp(log_prior_of_number(2, n) - log_prior_of_number(1, n));
  EXPECT_NEAR(find(gap, "mass+stiffness").odds / find(gap, "stiffness").odds / prior, two / one,
              0.015 * two / one);
}

TEST(ResonanceGap, OddsWithDampingAreThoseOfSampledPriors) {
  const ResonanceDiagnosis gap = paper();
  Sampled draw;
  const Prior left = log_usual("ratio", "1", 0.3, 3., 0.03, 30., 1.).prior;
  // zeta' / zeta of a joint of stiffness r and a series spring, k = total.
  const auto weighted = [&](double r, double total) {
    const double factor = std::pow(total, 1.5) / (r * r);
    return Draw{1. / total, std::exp(left.log_density(std::log(0.54 / factor)))};
  };
  const double one = sampled_evidence([&] {
    const double r = 1. / (0.71 / draw.modulus() + 0.29);
    return weighted(r, r);
  });
  const double two = sampled_evidence([&] {
    const double r = 1. / (0.71 / draw.modulus() + 0.29);
    return weighted(r, 1. / (1. / r + 1. / draw.series()));
  });
  const std::size_t n = resonance_effects(37.32, 2.04e6).size();
  const double prior = std::exp(log_prior_of_number(2, n) - log_prior_of_number(1, n) +
                                find_effect("base_compliance").log_prior);
  EXPECT_NEAR(find(gap, "base_compliance+stiffness").odds / find(gap, "stiffness").odds / prior,
              two / one, 0.015 * two / one);
}

TEST(ResonanceGap, FiguresThatAgreeNeedNoCause) {
  for (const double deviation : {0.002, 0.01, 0.03})
    for (const double gap_in_deviations : {-1.9, -1., 0., 1., 1.9}) {
      const ResonanceData simulated{.frequency_hz = 37.32, .relative_deviation = deviation};
      ResonanceData measured = simulated;
      measured.frequency_hz *= std::exp(gap_in_deviations * std::sqrt(2.) * deviation);
      EXPECT_EQ(explain_resonance_gap(simulated, measured).verdict, "none")
          << deviation << " " << gap_in_deviations;
    }
  const ResonanceDiagnosis same =
      explain_resonance_gap({.frequency_hz = 37.32, .damping_ratio = 0.05},
                            {.frequency_hz = 37.32, .damping_ratio = 0.05});
  EXPECT_EQ(same.verdict, "none");
  EXPECT_GT(same.explanations.front().odds, 0.5);
}

TEST(ResonanceGap, ADampingRatioThatDiffersAloneIsDamping) {
  const ResonanceDiagnosis gap =
      explain_resonance_gap({.frequency_hz = 37.32, .damping_ratio = 0.05},
                            {.frequency_hz = 37.32, .damping_ratio = 0.027});
  EXPECT_EQ(gap.verdict, "damping");
  EXPECT_NEAR(value(gap.explanations.front(), "ratio"), 0.54, 1e-12);
}

TEST(ResonanceGap, AHigherResonanceHasOtherExplanations) {
  const ResonanceDiagnosis gap =
      explain_resonance_gap({.frequency_hz = 31.47}, {.frequency_hz = 37.32});
  EXPECT_FALSE(find(gap, "base_compliance").possible);
  EXPECT_FALSE(find(gap, "softening_history").possible);
  EXPECT_FALSE(find(gap, "mount_compliance").possible);
  EXPECT_TRUE(find(gap, "viscoelastic").possible);
  EXPECT_NEAR(value(find(gap, "mass"), "ratio"), 0.711, 5e-4);
}

TEST(ResonanceGap, WhatNoEffectReachesIsOutsideTheCatalogue) {
  const ResonanceDiagnosis gap =
      explain_resonance_gap({.frequency_hz = 37.32}, {.frequency_hz = 3732.});
  EXPECT_EQ(gap.verdict, "outside_catalogue");
  for (const ResonanceExplanation& e : gap.explanations) EXPECT_TRUE(std::isfinite(e.odds));
}

TEST(ResonanceGap, AModulusThatIsNotKnownMayBeWrongEitherWay) {
  const auto stiffness = [](std::optional<double> modulus) {
    return resonance_effects(37.32, modulus).front();
  };
  EXPECT_NEAR(stiffness(2.04e6).usual_low, 0.73 / 2.04, 1e-12);
  EXPECT_NEAR(stiffness(2.04e6).usual_high, 1., 1e-12);
  EXPECT_NEAR(stiffness(0.73e6).usual_high, 2.04 / 0.73, 1e-12);
  for (const auto& modulus : {std::optional<double>{}, std::optional<double>{9e6}})
    EXPECT_NEAR(stiffness(modulus).usual_low * stiffness(modulus).usual_high, 1., 1e-12);
}

TEST(ResonanceGap, RefusesFiguresThatCannotBe) {
  const ResonanceData good{.frequency_hz = 37.32};
  for (const double bad : {0., -1., double(NAN), double(INFINITY)})
    EXPECT_THAT([&] { explain_resonance_gap(good, {.frequency_hz = bad}); },
                ThrowsMessage<signals::UserError>(HasSubstr("the measured frequency [Hz] is")));
  for (const double bad : {0., 1., 5., double(NAN)})
    EXPECT_THAT([&] { explain_resonance_gap({.frequency_hz = 1., .damping_ratio = bad}, good); },
                ThrowsMessage<signals::UserError>(HasSubstr("the simulated damping ratio is")));
  for (const double bad : {0., -0.2, 1.1, double(NAN)})
    EXPECT_THAT([&] { explain_resonance_gap(good, good, {.joint_share = bad}); },
                ThrowsMessage<signals::UserError>(HasSubstr("share of the compliance")));
  for (const double bad : {0., 0.5, double(NAN)})
    EXPECT_THAT(
        [&] { explain_resonance_gap(good, {.frequency_hz = 1., .relative_deviation = bad}); },
        ThrowsMessage<signals::UserError>(HasSubstr("relative deviation")));
}

}  // namespace
}  // namespace vibrissa::diagnosis
