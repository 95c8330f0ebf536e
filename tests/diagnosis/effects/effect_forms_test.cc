#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "diagnosis/model/effect.h"
#include "diagnosis/response/linear_response.h"
#include "diagnosis/search/search.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

Chain with(const std::string& id, const std::vector<double>& values, double joint_share = 0.7) {
  Chain chain{.structure = {.modes = {{.frequency_rad_s = 220.,
                                       .damping_ratio = 0.02,
                                       .base_gain = -2e-5,
                                       .base_rate = -2e-5 * 0.04}},
                            .has_base = true}};
  chain.joint_share = joint_share;
  find_effect(id).extend(chain, values, {});
  return chain;
}

double resonance_rad_s(const Chain& chain) {
  const LinearResponse response(chain);
  const auto height = [&](double w) { return std::abs(response.at(Complex(0., w)).base); };
  double best = 0., where = 0.;
  for (double w = 120.; w < 320.; w += 0.01)
    if (height(w) > best) best = height(where = w);
  return where;
}

TEST(Stiffness, IsThatOfTheFirstModeWhateverShareOfItTheJointHas) {
  for (const double ratio : {0.6, 0.95, 1.2})
    for (const double joint_share : {0.5, 0.7, 1.})
      for (const double modal_share : {0., 0.4, 1.}) {
        const Chain chain = with("stiffness", {ratio, 0.5, modal_share, 0.5}, joint_share);
        // Light damping shifts the peak by a few ten-thousandths.
        EXPECT_NEAR(resonance_rad_s(chain) / (220. * std::sqrt(ratio)), 1., 2e-3)
            << ratio << " " << joint_share << " " << modal_share;
      }
}

TEST(Stiffness, LeavesTheStaticMomentAlone) {
  const double nominal =
      std::abs(LinearResponse(with("stiffness", {1., 0., 0.5, 0.5})).at(0.).base);
  for (const double modal_share : {0., 1.}) {
    const Chain softer = with("stiffness", {0.6, 0., modal_share, 0.5});
    EXPECT_NEAR(std::abs(LinearResponse(softer).at(0.).base) / nominal, 1., 1e-12);
  }
}

/// A model with two modes and sensitivities to its silicone (0.56 of the first mode's compliance),
/// its wire and the density of its fin.
Chain solid_with(const std::string& id, const std::vector<double>& values) {
  Chain chain{.structure = {.modes = {{.frequency_rad_s = 220.,
                                       .damping_ratio = 0.02,
                                       .base_gain = -2e-5,
                                       .base_rate = -2e-5 * 0.04},
                                      {.frequency_rad_s = 3000.,
                                       .damping_ratio = 0.02,
                                       .base_gain = -2e-6,
                                       .base_rate = -2e-6 * 0.04}},
                            .base_direct = -1e-6,
                            .has_base = true}};
  chain.structure.paths = {{"silicone_modulus", {{0.28, 0.33}, {-0.02, 0.01}, {0., 0.}}},
                           {"wire_modulus", {{0.22, 0.16}, {0.02, -0.02}, {0., 0.}}},
                           {"fin_density", {{-0.46, -0.21}, {0.9, -0.01}, {0., 0.}, 0.8}}};
  chain.joint_share = 0.56;
  find_effect(id).extend(chain, values, {});
  return chain;
}

TEST(Stiffness, FollowsSiliconeAndWireOfAModelThatKnowsThem) {
  const double ratio = 0.8;
  for (const double wire_share : {0., 0.3, 1.}) {
    const Chain chain = solid_with("stiffness", {ratio, 0.5, wire_share, 0.5});
    EXPECT_NEAR(chain.structure.modes[0].frequency_rad_s, 220. * std::sqrt(ratio), 1e-9);
    // Springs in series: 1 / r = p / x + 1 - p.
    const double silicone = 0.56 / (std::pow(ratio, wire_share - 1.) - 0.44),
                 wire = 0.44 / (std::pow(ratio, -wire_share) - 0.56);
    EXPECT_NEAR(chain.structure.modes[1].frequency_rad_s,
                3000. * std::pow(silicone, 0.33) * std::pow(wire, 0.16), 1e-8);
    EXPECT_NEAR(chain.structure.base_response(0.).real(), -2.3e-5, 1e-18);
    EXPECT_NEAR(chain.joint_stiffness, silicone, 1e-12);
    // Springs in series: the softer joint has more of the compliance.
    EXPECT_NEAR(chain.joint_share, 0.56 / silicone / (0.56 / silicone + 0.44), 1e-12);
  }
}

TEST(Stiffness, OfSofterSiliconeTurnsAHallElementFurther) {
  const auto reading = [](const Chain& chain) {
    return LinearResponse(chain).at(0., signals::Readout::rotation).base.real();
  };
  const double silicone = 0.56 / (1. / 0.8 - 0.44);
  EXPECT_NEAR(reading(solid_with("stiffness", {0.8, 0.5, 0.})) /
                  reading(solid_with("stiffness", {1., 0.5, 0.})),
              1. / silicone, 1e-9);
  EXPECT_NEAR(reading(solid_with("stiffness", {0.8, 0.5, 1.})) /
                  reading(solid_with("stiffness", {1., 0.5, 0.})),
              1., 1e-9);
}

TEST(Mass, FollowsTheFinsDensityOfAModelThatKnowsIt) {
  const double ratio = 0.9, density = std::pow(ratio, 0.5 / 0.46);
  const Chain chain = solid_with("mass", {ratio, 1., 0.});
  EXPECT_NEAR(chain.structure.modes[0].frequency_rad_s, 220. / std::sqrt(ratio), 1e-9);
  EXPECT_NEAR(chain.structure.modes[1].frequency_rad_s, 3000. * std::pow(density, -0.21), 1e-8);
  // Base motion forces the first mode in proportion to the given mass ratio and not to the model's
  // own mass.
  EXPECT_NEAR(chain.structure.modes[0].base_gain * chain.mount.front()(0.).real(), -2e-5 * ratio,
              1e-16);
}

Complex lowpass(double corner_hz, double n_lags, double f_hz) {
  const Chain chain = with("sensor_lowpass", {corner_hz, 0., n_lags});
  return LinearResponse(chain).at(Complex(0., 2. * std::numbers::pi * f_hz)).sensor;
}

TEST(SensorLowpass, HasItsCornerAtMinusThreeDecibels) {
  for (const double n_lags : {1., 1.7, 3.})
    EXPECT_NEAR(std::abs(lowpass(80., n_lags, 80.)), std::sqrt(0.5), 1e-12) << n_lags;
}

TEST(SensorLowpass, OfOneLagIsOneLag) {
  const Complex expected = 1. / Complex(1., 50. / 80.);
  EXPECT_LT(std::abs(lowpass(80., 1., 50.) - expected), 1e-12);
}

TEST(SensorLowpass, OfThreeLagsIsAnAverageOverTimeToThirdOrder) {
  // (1 - exp(-s T)) / (s T), which equals (1 + s T / 6)^-3 up to (s T)^3 / 216 and higher powers.
  constexpr double length_s = 2e-3;
  constexpr double w = 3. / (0.5 * length_s);
  const double corner_hz = w * std::sqrt(std::exp2(1. / 3.) - 1.) / (2. * std::numbers::pi);
  for (const double f_hz : {10., 20., 40.}) {
    const Complex st(0., 2. * std::numbers::pi * f_hz * length_s);
    const Complex average = (1. - std::exp(-st)) / st;
    EXPECT_LT(std::abs(lowpass(corner_hz, 3., f_hz) - average), std::pow(std::abs(st), 3) / 200.);
  }
}

TEST(Hum, OfMainsThatAreALittleOffIsFoundToAHundredthOfAHertz) {
  SearchOptions hum_alone{.max_effects = 1};
  for (const Effect& effect : effect_catalogue())
    if (effect.id != "hum") hum_alone.left_out.push_back(effect.id);
  for (const double frequency_hz : {49.96, 50.08, 99.95, 119.9}) {
    test::OneModeRig rig = test::noisy_rig();
    rig.hum = 1.5e-5;
    rig.hum_hz = frequency_hz;
    signals::Dataset records = test::rig_dataset(rig);
    for (const std::size_t n : {2000, 4096, 5000}) {
      records.records.push_back(records.records.front());
      records.records.back().record =
          rig.record(n, 0., test::no_signal, test::no_signal, 90, false);
    }
    const SearchResult result =
        search(prepare_experiment(test::nominal_of(test::OneModeRig{}, false), records,
                                  signals::Split::fit, InputNoise::reduced),
               hum_alone);
    ASSERT_EQ(result.candidates.front().name, "hum");
    const HypothesisFit& fit = result.fits[result.candidates.front().fit];
    const auto found = [&](std::size_t parameter) {
      const std::size_t index = fit.index("hum", parameter).value();
      return fit.fit_parameters[index].description.value(fit.x(static_cast<Eigen::Index>(index)));
    };
    EXPECT_NEAR(found(1), frequency_hz, 0.01);
    EXPECT_NEAR(found(0), rig.hum, 0.1 * rig.hum) << frequency_hz;
  }
}

}  // namespace
}  // namespace vibrissa::diagnosis
