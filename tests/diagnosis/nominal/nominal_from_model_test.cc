
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "diagnosis/nominal/nominal_identification.h"
#include "signals/base/error.h"

namespace vibrissa::diagnosis {
namespace {

signals::ReducedModel two_modes() {
  signals::ReducedModel model;
  model.name = "two modes";
  model.modes = {{37., 0.05, {0.011, 0., 0.}, {0., 7e-4, 0.}},
                 {37., 0.05, {0., 0.011, 0.}, {-7e-4, 0., 0.}},
                 {170., 0.03, {0.004, 0., 0.}, {0., -9e-5, 0.}}};
  model.rigid_moment[1][0] = 9e-6;
  model.rigid_moment[0][1] = -9e-6;
  model.wind = {.speed_m_s = {0., 2.},
                .modal_coefficient = {{0., 0., 0.}, {4e-3, 0., 1e-4}},
                .moment_coefficient = {{0., 0., 0.}, {0., 3.5e-6, 0.}}};
  return model;
}

TEST(NominalFromModel, HasTheModelsBaseResponse) {
  const signals::ReducedModel model = two_modes();
  const NominalModel nominal = nominal_from(model);
  const std::vector<double> frequency_hz{1., 20., 36., 40., 150., 220.};
  const auto expected = signals::base_response(model, frequency_hz);
  for (std::size_t i = 0; i < frequency_hz.size(); ++i) {
    const Complex s(0., 2. * std::numbers::pi * frequency_hz[i]);
    EXPECT_LT(std::abs(nominal.base_response(s) - expected[i]), 1e-12 * std::abs(expected[0]));
  }
}

TEST(NominalFromModel, LeavesOutTheModesOfTheOtherPlaneAndPutsTheStrongestFirst) {
  const NominalModel nominal = nominal_from(two_modes());
  ASSERT_EQ(nominal.modes.size(), 2U);
  EXPECT_NEAR(nominal.modes.front().frequency_rad_s, 2. * std::numbers::pi * 37., 1e-9);
}

TEST(NominalFromModel, HasTheSteadyMomentOfTheWind) {
  const signals::ReducedModel model = two_modes();
  EXPECT_NEAR(nominal_from(model).wind_response(0.).real() * 4.,
              signals::steady_wind_moment(model, 2.), 1e-15);
}

TEST(NominalFromModel, TakesTheJointsShareFromTheSensitivityToTheSilicone) {
  signals::ReducedModel model = two_modes();
  model.sensitivities = {{.parameter = "silicone_modulus",
                          .nominal_value = 2e6,
                          .unit = "Pa",
                          .frequency = {0.28, 0.28, 0.1},
                          .base_gain = {0., 0., 0.},
                          .wind_gain = {0., 0., 0.}}};
  EXPECT_NEAR(nominal_from(model).joint_share, 0.56, 1e-12);
}

TEST(NominalFromModel, HasTheDragCurveOfAWindLoadThatHasOne) {
  signals::ReducedModel model = two_modes();
  model.wind = {
      .speed_m_s = {-2., 0., 2., 4.},
      .modal_coefficient = {{4e-3, 0., 0.}, {5e-3, 0., 0.}, {4e-3, 0., 0.}, {3e-3, 0., 0.}},
      .moment_coefficient = {{0., 4e-6, 0.}, {0., 5e-6, 0.}, {0., 4e-6, 0.}, {0., 3e-6, 0.}}};
  const NominalModel nominal = nominal_from(model);
  for (const double u : {-3., -2., -0.5, 0., 1., 2., 3., 5.})
    EXPECT_NEAR(nominal.wind_response(0.).real() * nominal.drag_curve.drag(u),
                signals::steady_wind_moment(model, u), 1e-12)
        << u;
  for (auto& coefficient : model.wind.moment_coefficient) coefficient = {0., 4e-6, 0.};
  EXPECT_TRUE(nominal_from(model).drag_curve.speed_m_s.empty());
}

/// The same model with every quantity changed along the path explicitly.
TEST(NominalFromModel, FollowsTheSensitivitiesOfItsOwnModes) {
  signals::ReducedModel model = two_modes();
  const double x = 0.7;
  model.sensitivities = {{.parameter = "fin_density",
                          .nominal_value = 1230.,
                          .unit = "kg/m^3",
                          .frequency = {-0.46, -0.46, -0.21},
                          .base_gain = {0.9, 0.9, -0.01},
                          .wind_gain = {-0.005, 0., 0.13},
                          .static_base_moment = 0.8}};
  NominalModel followed = nominal_from(model);
  followed.follow(*followed.path("fin_density"), std::log(x));

  for (const std::size_t k : {0U, 2U}) {
    const signals::Sensitivity& s = model.sensitivities.front();
    model.modes[k].frequency_hz *= std::pow(x, s.frequency[k]);
    model.modes[k].participation[0] *= std::pow(x, s.base_gain[k]);
    model.wind.modal_coefficient[1][k] *= std::pow(x, s.wind_gain[k]);
  }
  model.rigid_moment[1][0] *= std::pow(x, 0.8);
  for (const double frequency_hz : {1., 36., 150.}) {
    const Complex s(0., 2. * std::numbers::pi * frequency_hz);
    const auto truth = nominal_from(model).responses(s), got = followed.responses(s);
    EXPECT_LT(std::abs(got.base / truth.base - 1.), 1e-12) << frequency_hz;
    EXPECT_LT(std::abs(got.wind / truth.wind - 1.), 1e-12) << frequency_hz;
  }
}

TEST(NominalFromModel, HasNoPathOfWhatTheModelDoesNotTellOrTheFirstModeDoesNotFeel) {
  signals::ReducedModel model = two_modes();
  EXPECT_EQ(nominal_from(model).path("silicone_modulus"), nullptr);
  model.sensitivities = {{.parameter = "silicone_modulus",
                          .nominal_value = 2e6,
                          .unit = "Pa",
                          .frequency = {0., 0., 0.3},
                          .base_gain = {0., 0., 0.},
                          .wind_gain = {0., 0., 0.}}};
  EXPECT_EQ(nominal_from(model).path("silicone_modulus"), nullptr);
}

TEST(NominalFromModel, RefusesAModelThatBaseMotionDoesNotMove) {
  signals::ReducedModel model = two_modes();
  for (auto& mode : model.modes) mode.participation = {0., 0., 0.};
  EXPECT_THAT([&] { nominal_from(model); },
              testing::ThrowsMessage<signals::UserError>(testing::HasSubstr("two modes")));
}

}  // namespace
}  // namespace vibrissa::diagnosis
