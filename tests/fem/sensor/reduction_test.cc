#include "fem/sensor/reduction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "signals/model/reduced_model.h"
#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

TEST(Reduction, SlowAccelerationGivesTheWholeStaticMassMomentWhateverTheNumberOfModes) {
  for (const unsigned int n_modes : {2u, 6u}) {
    auto parameters = flow_sensor(1);
    parameters.model.n_modes = n_modes;
    const Sensor sensor(parameters);
    const auto model = reduce(sensor);
    const std::vector<double> slow{1e-4};
    const double expected = -model.rigid_moment[1][0];
    EXPECT_NEAR(signals::base_response(model, slow).front().real(), expected,
                1e-8 * std::abs(expected));
    Vector momentum = sensor.space().make_vector();
    sensor.operators().mass->vmult(momentum, sensor.space().translation(0));
    EXPECT_NEAR(momentum * sensor.space().rotation(1), -expected, 1e-12 * std::abs(expected));
  }
}

TEST(Reduction, SteadyWindGivesTheMomentOfThePressure) {
  const Sensor sensor(flow_sensor(1));
  const auto model = reduce(sensor);
  for (const double speed : {-3., 0.7, 2., 4.}) {
    Vector force = sensor.space().make_vector();
    sensor.wind_surface().add_force(speed, force);
    const double expected = force * sensor.space().rotation(1);
    EXPECT_NEAR(signals::steady_wind_moment(model, speed), expected, 2e-3 * std::abs(expected));
  }
}

TEST(Reduction, ModalWindForceIsThePressuresWorkOnTheShape) {
  const Sensor sensor(whisker_sensor(1));
  const auto model = reduce(sensor);
  const std::size_t at = model.wind.speed_m_s.size() - 1;
  const double u = model.wind.speed_m_s[at];
  Vector force = sensor.space().make_vector();
  sensor.wind_surface().add_force(u, force);
  for (std::size_t k = 0; k < model.modes.size(); k += 2) {
    const double expected = force * sensor.modes()[k].shape;
    EXPECT_NEAR(model.wind.modal_coefficient[at][k] * u * u, expected, 1e-9 * std::abs(expected));
  }
}

TEST(Reduction, AxialDirectionTurnsTheModelOfASymmetricSensorUnchanged) {
  auto parameters = whisker_sensor(1);
  const std::vector<double> f{5., 27., 60.};
  const auto straight = signals::base_response(reduce(Sensor(parameters)), f);
  parameters.model.axial_angle_deg = 90.;
  const auto turned = signals::base_response(reduce(Sensor(parameters)), f);
  for (std::size_t i = 0; i < f.size(); ++i) {
    EXPECT_LT(std::abs(turned[i] - straight[i]), 1e-5 * std::abs(straight[i]));
  }
}

}  // namespace
}  // namespace vibrissa::fem
