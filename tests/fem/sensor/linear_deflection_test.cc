#include <gmock/gmock.h>  // before deal.II, whose Assert is a macro

#include "fem/sensor/linear_deflection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

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
  double largest = 0.;
  std::vector<std::array<double, 2>> found_and_expected;
  for (const Mode& mode : sensor.modes()) {
    const double w = 2. * std::numbers::pi * mode.frequency_hz;
    double expected = 0.;
    for (unsigned int d = 0; d < 3; ++d)
      expected -= mode.participation[d] * acceleration[d] / (w * w);
    found_and_expected.push_back({momentum * mode.shape, expected});
    largest = std::max(largest, std::abs(expected));
  }
  EXPECT_GT(largest, 1e-6);
  // Torsion has no part in it.
  for (const auto& [found, expected] : found_and_expected)
    EXPECT_NEAR(found, expected, 1e-11 * largest);
}

}  // namespace
}  // namespace vibrissa::fem
