#include "flow/drag_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vibrissa::flow {
namespace {

constexpr double wire_width_m = 0.58e-3;
constexpr double blade_width_m = 12e-3;
const Air air;

double wire_drag(const double reynolds) {
  return drag_coefficient(DragBody::wire, reynolds);
}

/// Exponent n of p ~ u^n between two speeds.
double pressure_exponent(const DragBody body, const double width_m, const double slow,
                         const double fast) {
  return std::log(drag_pressure(body, width_m, fast, air) /
                  drag_pressure(body, width_m, slow, air)) /
         std::log(fast / slow);
}

// Ranges around the measurements of Wieselsberger (1921), Tritton (1959), and Jayaweera and Mason
// (1965), as wide as these and the common fits to them scatter.
TEST(WireDrag, LiesWithinTheMeasuredRange) {
  EXPECT_GT(wire_drag(0.1), 50.);
  EXPECT_LT(wire_drag(0.1), 65.);
  EXPECT_GT(wire_drag(1.), 9.5);
  EXPECT_LT(wire_drag(1.), 12.5);
  EXPECT_GT(wire_drag(10.), 2.6);
  EXPECT_LT(wire_drag(10.), 3.3);
  EXPECT_GT(wire_drag(40.), 1.5);
  EXPECT_LT(wire_drag(40.), 1.9);
  EXPECT_GT(wire_drag(100.), 1.25);
  EXPECT_LT(wire_drag(100.), 1.5);
  EXPECT_GT(wire_drag(1e4), 1.0);
  EXPECT_LT(wire_drag(1e4), 1.2);
}

// Cheng, J. Hydraul. Eng. 139 (2013) 602: a later fit of another form to the same measurements.
TEST(WireDrag, AgreesWithAnIndependentFitWithinTwentyPercentFromCreepingFlowToTheDragCrisis) {
  for (double re = 0.01; re < 2e5; re *= 1.3) {
    const double cheng = 11. * std::pow(re, -0.75) + 0.9 * (1. - std::exp(-1000. / re)) +
                         1.2 * (1. - std::exp(-std::pow(re / 4500., 0.7)));
    EXPECT_NEAR(wire_drag(re) / cheng, 1., 0.2) << "Re = " << re;
  }
}

// Lamb's drag a length, 4 pi mu U / (1/2 - gamma - ln(Re/8)), is exact as Re -> 0.
TEST(WireDrag, TendsToLambsLawInCreepingFlow) {
  double previous = 1.;
  for (const double re : {1e-2, 1e-4, 1e-8, 1e-16}) {
    const double lamb = 8. * M_PI / (re * (0.5 - 0.57721566490153286 - std::log(re / 8.)));
    const double error = std::abs(wire_drag(re) / lamb - 1.);
    EXPECT_LT(error, 0.6 * previous) << "Re = " << re;
    previous = error;
  }
  EXPECT_LT(previous, 1e-3);
}

TEST(WireDrag, IsContinuousAndFallsSteadilyWithReynoldsNumber) {
  const double step = 1e-4;
  for (double re = 1e-3; re < 2e5; re *= 1. + step) {
    const double exponent = std::log(wire_drag(re * (1. + step)) / wire_drag(re)) / step;
    ASSERT_LT(exponent, 0.) << "Re = " << re;
    ASSERT_GT(exponent, -1.) << "Re = " << re;
  }
}

TEST(WireDrag, JoinsItsTwoLawsWithoutAStep) {
  const double join = 0.3823206439670511;
  const double below = wire_drag(std::nextafter(join, 0.)), above = wire_drag(join);
  EXPECT_NEAR(below / above, 1., 1e-13);
}

TEST(BladeDrag, IsThatOfAPlateAtAnyReynoldsNumber) {
  for (const double re : {100., 1e3, 1e5})
    EXPECT_DOUBLE_EQ(drag_coefficient(DragBody::blades, re), 1.2);
}

TEST(DragPressure, IsHalfDensityTimesCoefficientTimesSpeedSquared) {
  for (const double speed : {1e-3, 0.5, 4.}) {
    const double re = speed * wire_width_m / air.kinematic_viscosity;
    EXPECT_NEAR(drag_pressure(DragBody::wire, wire_width_m, speed, air) /
                    (0.5 * air.density * wire_drag(re) * speed * speed),
                1., 1e-14);
  }
  // 0.5 x 1.204 kg/m^3 x 1.2 x (2 m/s)^2
  EXPECT_DOUBLE_EQ(drag_pressure(DragBody::blades, blade_width_m, 2., air), 2.8896);
}

TEST(DragPressure, ChangesSignWithTheWind) {
  for (const DragBody body : {DragBody::wire, DragBody::blades})
    for (const double speed : {1e-9, 0.003, 0.7, 5.})
      EXPECT_EQ(drag_pressure(body, wire_width_m, -speed, air),
                -drag_pressure(body, wire_width_m, speed, air));
}

TEST(DragPressure, VanishesInStillAirAndDoesSoContinuously) {
  for (const DragBody body : {DragBody::wire, DragBody::blades}) {
    EXPECT_EQ(drag_pressure(body, wire_width_m, 0., air), 0.);
    double previous = drag_pressure(body, wire_width_m, 1., air);
    for (const double speed : {1e-2, 1e-6, 1e-100, std::numeric_limits<double>::denorm_min()}) {
      const double pressure = drag_pressure(body, wire_width_m, speed, air);
      EXPECT_GE(pressure, 0.) << speed;
      EXPECT_LT(pressure, previous) << speed;
      previous = pressure;
    }
  }
}

TEST(DragPressure, OfTheWireGrowsMoreSlowlyThanTheSquareInOneToFourMetresASecond) {
  const double exponent = pressure_exponent(DragBody::wire, wire_width_m, 1., 4.);
  EXPECT_GT(exponent, 1.7);
  EXPECT_LT(exponent, 1.8);
}

TEST(DragPressure, OfTheBladesGrowsWithTheSquare) {
  EXPECT_NEAR(pressure_exponent(DragBody::blades, blade_width_m, 1., 4.), 2., 1e-14);
}

TEST(DragPressure, IsProportionalToTheDensityAtEqualReynoldsNumber) {
  const Air thick{2. * air.density, air.kinematic_viscosity};
  EXPECT_DOUBLE_EQ(drag_pressure(DragBody::wire, wire_width_m, 2., thick),
                   2. * drag_pressure(DragBody::wire, wire_width_m, 2., air));
}

}  // namespace
}  // namespace vibrissa::flow
