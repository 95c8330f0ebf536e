#include <gmock/gmock.h>  // before deal.II, whose Assert is a macro

#include "fem/linear_deflection.h"

#include <cmath>
#include <numbers>

#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

// phi_k^T K u = w_k^2 phi_k^T M u for every mode, and K u = -M a.
TEST(LinearDeflection, HasInEveryModeWhatTheModeItselfWouldTake) {
  const Sensor sensor(flow_sensor(1));
  const std::array<double, 3> acceleration{9.80665, -3., 20.};
  const Vector bent = linear_deflection(sensor, acceleration);
  Vector momentum = sensor.space().make_vector();
  sensor.operators().mass->vmult(momentum, bent);
  for (const Mode& mode : sensor.modes()) {
    const double w = 2. * std::numbers::pi * mode.frequency_hz;
    double expected = 0., largest = 0.;
    for (unsigned int d = 0; d < 3; ++d) {
      expected -= mode.participation[d] * acceleration[d] / (w * w);
      largest += std::abs(mode.participation[d] * acceleration[d]) / (w * w);
    }
    EXPECT_NEAR(momentum * mode.shape, expected, 1e-7 * largest) << mode.frequency_hz << " Hz";
  }
}

}  // namespace
}  // namespace vibrissa::fem
