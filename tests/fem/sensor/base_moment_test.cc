#include "fem/sensor/base_moment.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/factors/cholesky_solver.h"
#include "fem/motion/linear_transient.h"
#include "fem/solid/internal_force.h"
#include "signals/model/reduced_model.h"
#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

SolidState state_at_rest(const SolidSpace& space) {
  return {space.make_vector(), space.make_vector(), space.make_vector()};
}

SolidLoad no_load(const SolidSpace& space) {
  return {{}, space.make_vector(), space.make_vector()};
}

/// Static state under a load, clamped.
void balance(const Sensor& sensor, SolidState& state, const SolidLoad& load) {
  const auto& space = sensor.space();
  Vector acceleration = space.make_vector(), force = space.make_vector();
  for (unsigned int d = 0; d < 3; ++d) {
    acceleration.add(load.base_acceleration[d], space.translation(d));
  }
  sensor.operators().mass->vmult(force, acceleration);
  force *= -1.;
  force += load.external_force;
  zero_entries(force, space.clamped());
  const CholeskySolver solver(*sensor.operators().clamped_stiffness,
                              [&](const Vector& x, Vector& product) {
                                product = 0.;
                                sensor.operators().internal_force->add(1., x, product);
                                zero_entries(product, space.clamped());
                              });
  solver.solve(force, state.displacement);
}

TEST(BaseMoment, ConstantAccelerationGivesMinusTheStaticMassMoment) {
  const Sensor sensor(flow_sensor(1));
  auto state = state_at_rest(sensor.space());
  auto load = no_load(sensor.space());
  load.base_acceleration = {2., 0., 0.};
  balance(sensor, state, load);
  Vector momentum = sensor.space().make_vector();
  sensor.operators().mass->vmult(momentum, sensor.space().translation(0));
  const double expected = -2. * (momentum * sensor.space().rotation(1));
  const BaseMoment moment(sensor.space(), sensor.operators());
  EXPECT_NEAR(moment.by_balance(state, load)[1], expected, 1e-12 * std::abs(expected));
  EXPECT_NEAR(moment.by_reactions(state, load)[1], expected, 1e-8 * std::abs(expected));
  EXPECT_LT(expected, 0.);
}

TEST(BaseMoment, WindAlongXGivesThePositiveMomentOfItsPressure) {
  const Sensor sensor(flow_sensor(1));
  auto state = state_at_rest(sensor.space());
  auto load = no_load(sensor.space());
  sensor.wind_surface().add_force(3., load.external_force);
  balance(sensor, state, load);
  const double expected = load.external_force * sensor.space().rotation(1);
  const BaseMoment moment(sensor.space(), sensor.operators());
  EXPECT_GT(expected, 0.);
  EXPECT_NEAR(moment.by_reactions(state, load)[1], expected, 1e-8 * expected);
}

TEST(BaseMoment, TwoRoutesAgreeInMotionForBothSensors) {
  for (const auto& parameters : {flow_sensor(1), whisker_sensor(1)}) {
    const Sensor sensor(parameters);
    std::vector<double> a(60), wind(60);
    for (std::size_t i = 0; i < a.size(); ++i) {
      a[i] = 4. * std::sin(0.4 * static_cast<double>(i));
      wind[i] = 2. + std::sin(0.1 * static_cast<double>(i));
    }
    const TransientInput input{500., a.size(), a, {}, wind};
    const auto output = simulate_linear(sensor, input, {0.9, 4, true}, {});
    EXPECT_LT(output.largest_route_difference(), 1e-8);
    EXPECT_GT(output.largest_route_difference(), 0.) << "the second route must be another one";
  }
}

}  // namespace
}  // namespace vibrissa::fem
