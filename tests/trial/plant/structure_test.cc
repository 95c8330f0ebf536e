#include "trial/plant/structure.h"

#include <gmock/gmock.h>

#include <numbers>

#include "trial/plant/plant.h"

namespace vibrissa::trial {
namespace {

const Structure& nominal() {
  static const Structure structure = solve_structure({});
  return structure;
}

std::complex<double> moment_per(const World& world, Eigen::Index input, double hz) {
  const std::complex<double> s(0., 2. * std::numbers::pi * hz);
  return make_plant(nominal(), world).response(s)(output::moment, input);
}

TEST(TrialStructure, HoldsTwelveModesOfThePlaneAndAlmostAllOfItsInertia) {
  EXPECT_GE(nominal().frequency_rad_s.size(), 12);
  EXPECT_NEAR(nominal().frequency_rad_s(0) / (2. * std::numbers::pi), 37.32, 0.1);
  EXPECT_NEAR(nominal().tilt.squaredNorm() / nominal().inertia_kg_m2, 1., 0.005);
}

TEST(TrialStructure, AStifferSiliconeRaisesTheResonanceByItsShare) {
  const Structure stiffer = solve_structure({.silicone_modulus = 1.04});
  const double gain = stiffer.frequency_rad_s(0) / nominal().frequency_rad_s(0);
  EXPECT_NEAR(2. * std::log(gain) / std::log(1.04), nominal().joint_share, 0.01);
}

TEST(TrialPlant, CarriesInertiaAndWindAtRest) {
  EXPECT_NEAR(moment_per({}, input::acceleration, 0.).real(), -nominal().first_moment_kg_m, 1e-12);
  EXPECT_NEAR(moment_per({}, input::tilt_acceleration, 0.).real(), -nominal().inertia_kg_m2, 1e-14);
  EXPECT_NEAR(moment_per({}, input::wind, 0.).real(), nominal().wind_moment, 1e-12);
  EXPECT_NEAR(moment_per({}, input::hinge, 0.).real(), 0., 1e-12) << "a moment within the sensor";
}

TEST(TrialPlant, ASpringUnderTheBaseStandsInSeriesWithTheHinge) {
  // Where the whisker's first mode is a hinge with an arm, springs in series add compliances.
  World world;
  world.base_compliance = 0.1;
  const double share = nominal().joint_share;
  const double expected =
      nominal().frequency_rad_s(0) / (2. * std::numbers::pi) / std::sqrt(1. + 0.1 * share);
  double peak_hz = 0., peak = 0.;
  for (double f = 30.; f < 40.; f += 0.01)
    if (const double height = std::abs(moment_per(world, input::acceleration, f)); height > peak) {
      peak = height;
      peak_hz = f;
    }
  EXPECT_NEAR(peak_hz, expected, 0.15);
  EXPECT_NEAR(moment_per(world, input::acceleration, 0.).real(), -nominal().first_moment_kg_m,
              1e-10);
}

TEST(TrialPlant, AMountThatIsVeryStiffChangesNothing) {
  World world;
  world.mount_hz = 5000.;
  for (const double f : {5., 30., 80.})
    EXPECT_NEAR(std::abs(moment_per(world, input::acceleration, f) /
                         moment_per({}, input::acceleration, f)),
                1., 1e-3)
        << f;
}

}  // namespace
}  // namespace vibrissa::trial
