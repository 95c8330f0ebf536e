#include "diagnosis/validation/parameter_estimates.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vibrissa::diagnosis {
namespace {

NominalModel solid() {
  NominalModel nominal;
  nominal.modes = {{.frequency_rad_s = 220., .damping_ratio = 0.05, .base_gain = -2e-5}};
  nominal.paths = {{"silicone_modulus", {{0.28}, {0.}, {0.}}},
                   {"wire_modulus", {{0.22}, {0.}, {0.}}},
                   {"fin_density", {{-0.46}, {0.9}, {0.}}}};
  return nominal;
}

/// A fit with only this effect and its parameters at these coordinates, each with a standard
/// deviation of 0.01 and without correlation.
HypothesisFit fit_of(const std::string& id, const std::vector<double>& x) {
  HypothesisFit fit;
  const Effect& effect = find_effect(id);
  fit.x.resize(static_cast<Eigen::Index>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) {
    fit.fit_parameters.push_back({&effect, i, effect.parameters[i], false});
    fit.x(static_cast<Eigen::Index>(i)) = x[i];
  }
  fit.covariance = 1e-4 * Eigen::MatrixXd::Identity(fit.x.size(), fit.x.size());
  return fit;
}

double modulus_ratio(const double log_ratio, const double wire_share) {
  return material_estimates(solid(), fit_of("stiffness", {log_ratio, 0.5, wire_share}),
                            "stiffness")[0]
      .value;
}

TEST(MaterialEstimates, OfSiliconeAloneMakeItASpringInSeriesWithTheWire) {
  const double log_ratio = std::log(0.81);
  const auto found =
      material_estimates(solid(), fit_of("stiffness", {log_ratio, 0.5, 0.}), "stiffness");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].name, "silicone_modulus_ratio");
  EXPECT_NEAR(0.56 / found[0].value + 0.44, 1. / 0.81, 1e-12);
  EXPECT_NEAR(found[1].value, 1., 1e-12);
  // Both coordinates are uncertain by 0.01.
  const auto slope = [&](const double in_ratio, const double in_share) {
    return (std::log(modulus_ratio(log_ratio + in_ratio, in_share)) - std::log(found[0].value)) /
           1e-6;
  };
  const double half = 1.96 * 0.01 * std::hypot(slope(1e-6, 0.), slope(0., 1e-6));
  EXPECT_NEAR(std::log(found[0].ci95[1] / found[0].value), half, 1e-4);
  EXPECT_NEAR(std::log(found[0].value / found[0].ci95[0]), half, 1e-4);
}

TEST(MaterialEstimates, AreOfAnAnswerThatNamesOthersToo) {
  const auto found =
      material_estimates(solid(), fit_of("stiffness", {std::log(0.7), 0.5, 1.}), "delay+stiffness");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].value, 1., 1e-12);
  EXPECT_NEAR(0.44 / found[1].value + 0.56, 1. / 0.7, 1e-12);
}

TEST(MaterialEstimates, OfAMassIsTheDensity) {
  const auto found = material_estimates(solid(), fit_of("mass", {std::log(0.86), 1., 0.}), "mass");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].name, "fin_density_ratio");
  EXPECT_NEAR(found[0].value, std::pow(0.86, 0.5 / 0.46), 1e-12);
}

TEST(MaterialEstimates, AreNoneWithoutAModelOrAnEffectThatTellsThem) {
  const auto fit = fit_of("stiffness", {std::log(0.8), 0.5, 0.});
  EXPECT_TRUE(material_estimates(NominalModel{}, fit, "stiffness").empty());
  EXPECT_TRUE(material_estimates(solid(), fit, "none").empty());
}

}  // namespace
}  // namespace vibrissa::diagnosis
