#include "fem/sensor/wind_state_load.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

class WindOnBoth : public testing::TestWithParam<bool> {
 protected:
  Vector force(const WindStateLoad& wind, const Vector& u, const Vector& v) const {
    Vector f = sensor.space().make_vector();
    wind.add_force(u, v, f);
    return f;
  }
  Vector at_rest(const double speed) const {
    Vector f = sensor.space().make_vector();
    sensor.wind_surface().add_force(speed, f);
    return f;
  }
  static double distance(const Vector& a, const Vector& b) {
    Vector difference(a);
    difference -= b;
    return difference.linfty_norm();
  }
  const Sensor sensor{GetParam() ? flow_sensor(1) : whisker_sensor(1)};
  const Vector rest{sensor.space().make_vector()};
};
INSTANTIATE_TEST_SUITE_P(Sensors, WindOnBoth, testing::Bool(), [](const auto& info) {
  return std::string(info.param ? "Flow" : "Whisker");
});

TEST_P(WindOnBoth, WithoutMotionIsThatOnTheSensorAtRestToTheLastBit) {
  for (const bool deformed : {false, true}) {
    for (const bool relative : {false, true}) {
      WindStateLoad wind(sensor.wind_surface(), {deformed, relative});
      wind.set({2.3, 0.});
      EXPECT_EQ(distance(force(wind, rest, rest), at_rest(2.3)), 0.);
    }
  }
}

TEST_P(WindOnBoth, TurnsWithTheBodyWhenItActsOnDeformedFaces) {
  const double angle = 0.8, c = std::cos(angle), s = std::sin(angle);
  const auto& space = sensor.space();
  // X turned about y; the rotations hold the coordinates: e_y x X = (z, 0, -x).
  Vector u = space.make_vector();
  const Vector& turn = space.rotation(1);
  for (const auto n : u.locally_owned_elements()) {
    if (n % 3 != 0) continue;
    const double x = -turn[n + 2], z = turn[n];
    u[n] = (c - 1.) * x + s * z;
    u[n + 2] = -s * x + (c - 1.) * z;
  }
  u.compress(dealii::VectorOperation::insert);
  WindStateLoad wind(sensor.wind_surface(), {true, false});
  wind.set({2.3, 0.});
  const Vector f = force(wind, u, rest), before = at_rest(2.3);
  double error = 0.;
  for (const auto n : u.locally_owned_elements()) {
    if (n % 3 != 0) continue;
    error = std::max({error, std::abs(f[n] - (c * before[n] + s * before[n + 2])),
                      std::abs(f[n + 1] - before[n + 1]),
                      std::abs(f[n + 2] - (-s * before[n] + c * before[n + 2]))});
  }
  EXPECT_LT(error, 1e-12 * before.linfty_norm());
}

TEST_P(WindOnBoth, OnlyTheSpeedPastTheWhiskerCounts) {
  WindStateLoad wind(sensor.wind_surface(), {false, true});
  Vector v(sensor.space().translation(0));
  v *= 0.7;
  v.add(3., sensor.space().translation(1), -2., sensor.space().translation(2));
  wind.set({3., 0.5});
  const Vector expected = at_rest(1.8);
  EXPECT_LT(distance(force(wind, rest, v), expected), 1e-12 * expected.linfty_norm());
  wind.set({1., 2.1});
  const Vector against = at_rest(-1.8);
  EXPECT_LT(distance(force(wind, rest, v), against), 1e-12 * against.linfty_norm());
}

TEST_P(WindOnBoth, BetweenSamplesThePressureIsTheirMean) {
  WindStateLoad wind(sensor.wind_surface(), {false, false});
  wind.set({1., 0.}, {3., 0.}, 0.25);
  Vector expected = at_rest(1.);
  expected.sadd(0.75, 0.25, at_rest(3.));
  EXPECT_LT(distance(force(wind, rest, rest), expected), 1e-14 * expected.linfty_norm());
}

}  // namespace
}  // namespace vibrissa::fem
