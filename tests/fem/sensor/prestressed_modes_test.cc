#include <gmock/gmock.h>  // before deal.II, whose Assert is a macro

#include "fem/sensor/prestressed_modes.h"

#include <cmath>

#include "fem/sensor/sensor.h"
#include "meshes/sensor_mesh.h"
#include "signals/base/error.h"
#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

const double wire_radius = 0.29e-3, wire_length = 89.9e-3, youngs_modulus = 70e9, density = 6450.;

/// First mode of the clamped beam, derivative and curvature at x / L, without a factor.
struct BeamShape {
  double slope, curvature;
};

BeamShape first_shape(const double x) {
  const double b = 1.8751040687119611;
  const double s = (std::cosh(b) + std::cos(b)) / (std::sinh(b) + std::sin(b));
  return {b * (std::sinh(b * x) + std::sin(b * x) - s * (std::cosh(b * x) - std::cos(b * x))),
          b * b * (std::cosh(b * x) + std::cos(b * x) - s * (std::sinh(b * x) + std::sin(b * x)))};
}

/// d(w^2) / w^2 of a beam under axial weight q per length, to first order: the work of the weight
/// q (L - x) on the slopes over that of the bending moment (Rayleigh's quotient with the exact mode
/// is stationary, so the mode's change counts in second order only).
double relative_change_by_weight(const double weight_n_m) {
  double work = 0., bending = 0.;
  constexpr int n = 2000;
  for (int i = 0; i < n; ++i) {
    const double x = (i + 0.5) / n;
    const auto [slope, curvature] = first_shape(x);
    work += (1. - x) * slope * slope;
    bending += curvature * curvature;
  }
  const double stiffness = youngs_modulus * M_PI * std::pow(wire_radius, 4) / 4.;
  return weight_n_m * std::pow(wire_length, 3) / stiffness * work / bending;
}

class HeavyWire : public testing::Test {
 protected:
  HeavyWire() {
    meshes::make_clamped_wire_mesh(2. * wire_radius, wire_length, 2, mesh);
    space = std::make_unique<SolidSpace>(mesh);
    operators = assemble_operators(
        *space, {{"wire", materials::make_elastic(youngs_modulus, 0.33, density, 0.)}});
  }
  double first_square(const double g_z) const {
    const double f = solve_modes_under({0., 0., g_z}, *space, operators, 2).front().frequency_hz;
    return f * f;
  }
  dealii::Triangulation<3> mesh;
  std::unique_ptr<SolidSpace> space;
  SolidOperators operators;
};

TEST_F(HeavyWire, StandsLowerAndHangsHigherAsABeamDoes) {
  const double g = 98.1, rest = first_square(0.);
  const double expected = relative_change_by_weight(density * M_PI * wire_radius * wire_radius * g);
  const double standing = first_square(-g) / rest - 1., hanging = first_square(g) / rest - 1.;
  EXPECT_GT(expected, 0.03);
  EXPECT_NEAR(0.5 * (hanging - standing) / expected, 1., 0.01);
  EXPECT_NEAR(standing / -expected, 1., 0.03);  // the second order is a few percent of it
}

TEST_F(HeavyWire, WithoutWeightNearlyIsAtRest) {
  EXPECT_NEAR(first_square(-1e-9) / first_square(0.), 1., 1e-6);
}

TEST_F(HeavyWire, BucklesUnderThreeHundredTimesGravity) {
  // Greenhill: q L^3 = 7.837 E I; here 9.4.
  EXPECT_THAT([&] { first_square(-9.81 * 300.); },
              testing::ThrowsMessage<signals::UserError>(testing::HasSubstr("Gravity")));
}

TEST(PrestressedModes, AWhiskerStandingUpRingsLower) {
  auto parameters = whisker_sensor(1);
  const double rest = Sensor(parameters).modes()[0].frequency_hz;
  parameters.gravity_m_s2 = {0., 0., -9.81};
  const double standing = Sensor(parameters).modes()[0].frequency_hz;
  parameters.gravity_m_s2 = {0., 0., 9.81};
  const double hanging = Sensor(parameters).modes()[0].frequency_hz;
  EXPECT_LT(standing, 0.9995 * rest);
  EXPECT_NEAR(standing + hanging, 2. * rest, 1e-4 * rest);
}

TEST(Calibration, HoldsOnlyAtItsFrequency) {
  auto parameters = whisker_sensor(1);
  parameters.model.calibration_note = "free length set to 27.20 Hz";
  EXPECT_TRUE(Sensor(parameters).calibration_note());
  parameters.model.calibrated_frequency_hz = 27.20;
  EXPECT_TRUE(Sensor(parameters).calibration_note());
  parameters.geometry.free_length *= 1.02;
  EXPECT_FALSE(Sensor(parameters).calibration_note());
}

}  // namespace
}  // namespace vibrissa::fem
