#include "separation/metrics/wind_speed.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using signals::UserError;
using test::Signal;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double k = 3e-5;

DragCalibration square_law(double relative_error = 0.) {
  return {[](double u) { return k * u * u; }, 10., relative_error};
}

TEST(WindSpeed, InvertsTheSquareLawOfEitherSign) {
  const Signal moment{-k * 9., 0., k * 1e-6, k * 4., k * 100.};
  const auto speeds = wind_speed(square_law(), moment, 0.);
  const Signal expected{-3., 0., 1e-3, 2., 10.};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(speeds[i].value_m_s, expected[i], 1e-14) << i;
    EXPECT_EQ(speeds[i].low_m_s, speeds[i].value_m_s);
    EXPECT_EQ(speeds[i].high_m_s, speeds[i].value_m_s);
  }
}

// Cd = 1 + 10 Re^(-2/3) (White): the speed of a moment computed from the speed itself.
TEST(WindSpeed, InvertsALawWhoseDragCoefficientFallsWithTheReynoldsNumber) {
  const DragCalibration calibration(
      [](double u) {
        const double reynolds = u * 0.58e-3 / 1.51e-5;
        return u > 0. ? k * (1. + 10. * std::pow(reynolds, -2. / 3.)) * u * u : 0.;
      },
      20.);
  for (const double speed : {-7., -0.01, 0.3, 1., 19.9})
    EXPECT_NEAR(calibration.speed_m_s(calibration.moment_n_m(speed)), speed,
                1e-12 * std::abs(speed));
}

TEST(WindSpeed, HasTheErrorBarOfLinearPropagationInStrongWind) {
  const double moment = k * 25., deviation = 1e-3 * moment;
  const WindSpeed speed = wind_speed(square_law(0.002), Signal{moment}, deviation)[0];
  // du = dM / (2 k u), the two errors added in squares.
  const double expected = moment * std::hypot(1e-3, 2e-3) / (2. * k * 5.);
  EXPECT_NEAR(speed.high_m_s - speed.value_m_s, expected, 2e-3 * expected);
  EXPECT_NEAR(speed.value_m_s - speed.low_m_s, expected, 2e-3 * expected);
}

TEST(WindSpeed, HasAFiniteErrorBarAroundZeroWhereLinearPropagationHasNone) {
  const WindSpeed speed = wind_speed(square_law(), Signal{0.}, k * 0.04)[0];
  EXPECT_NEAR(speed.low_m_s, -0.2, 1e-12);
  EXPECT_NEAR(speed.high_m_s, 0.2, 1e-12);
}

TEST(WindSpeed, HoldsTheTruthInTwoThirdsOfNoisyMoments) {
  const Signal noise = test::white_noise(20000, k * 0.5, 1);
  for (const double truth : {0.5, 2., 6.}) {
    Signal moment = noise;
    for (double& value : moment) value += k * truth * truth;
    double n_inside = 0.;
    for (const WindSpeed& speed : wind_speed(square_law(), moment, k * 0.5))
      n_inside += speed.low_m_s <= truth && truth <= speed.high_m_s ? 1. : 0.;
    EXPECT_NEAR(n_inside / 20000., 0.6827, 0.015) << truth;  // 4.5 deviations of a count
  }
}

TEST(WindSpeed, OfPointsOfASquareLawIsExactBetweenThem) {
  const auto calibration = DragCalibration::from_points({{1., k}, {2., 4. * k}, {5., 25. * k}});
  for (const double speed : {0.3, 1., 1.7, 4.4, 5.})
    EXPECT_NEAR(calibration.speed_m_s(k * speed * speed), speed, 1e-13);
  EXPECT_EQ(calibration.highest_speed_m_s(), 5.);
  EXPECT_NEAR(calibration.highest_moment_n_m(), 25. * k, 1e-18);
}

TEST(WindSpeed, IsNeverContinuedBeyondTheCalibration) {
  const auto speeds = wind_speed(square_law(), Signal{k * 101., k * 99.}, k * 2.);
  EXPECT_TRUE(std::isnan(speeds[0].value_m_s));
  EXPECT_NEAR(speeds[0].low_m_s, std::sqrt(99.), 1e-12);
  EXPECT_NEAR(speeds[1].value_m_s, std::sqrt(99.), 1e-12);
  EXPECT_TRUE(std::isnan(speeds[1].high_m_s));
}

TEST(WindSpeed, RefusesWhatHasNoInverse) {
  const auto refuse = [](const std::function<void()>& call, const std::string& message) {
    EXPECT_THAT(call, ThrowsMessage<UserError>(HasSubstr(message)));
  };
  refuse([] { DragCalibration([](double u) { return u * (2. - u); }, 3.); },
         "does not increase at 1.002 m/s");
  refuse([] { DragCalibration([](double u) { return u + 1.; }, 3.); }, "gives 1 N m at rest");
  refuse([] { DragCalibration([](double u) { return u; }, 0.); }, "highest_speed_m_s = 0");
  refuse([] { DragCalibration([](double u) { return u; }, 1., -0.1); }, "relative_error = -0.1");
  refuse([] { DragCalibration::from_points({}); }, "no points");
  refuse([] { DragCalibration::from_points({{1., 2.}, {2., 2.}}); }, "point 2 (2 m/s, 2 N m)");
  refuse([] { DragCalibration::from_points({{0., 0.}}); }, "point 1 (0 m/s, 0 N m)");
  refuse([] { wind_speed(square_law(), Signal{0.}, -1.); }, "moment_deviation_n_m = -1");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refuse([&] { wind_speed(square_law(), Signal{0., nan}, 1.); }, "not finite at sample 1");
}

}  // namespace
}  // namespace vibrissa::separation
