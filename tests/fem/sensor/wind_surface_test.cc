#include "fem/sensor/wind_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "flow/drag_law.h"
#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

double drag(const Sensor& sensor, const double speed) {
  Vector force = sensor.space().make_vector();
  sensor.wind_surface().add_force(speed, force);
  return force * sensor.space().translation(0);
}

TEST(WindSurface, ResultantOnTheWireIsItsDrag) {
  const auto parameters = whisker_sensor(2);
  const Sensor sensor(parameters);
  const double d = parameters.geometry.wire_diameter, l = parameters.geometry.free_length;
  const double expected = flow::drag_pressure(flow::DragBody::wire, d, 2.5, {}) * d * l;
  EXPECT_NEAR(drag(sensor, 2.5), expected, 2e-3 * expected);
}

TEST(WindSurface, ResultantOnTheFinIsTheDragOnItsFrontalArea) {
  auto parameters = flow_sensor(1);
  parameters.model.wind_on_wire = false;
  const Sensor sensor(parameters);
  const auto& g = parameters.geometry;
  const double area = 0.5 * (g.fin_top_width + g.fin_bottom_width) * g.fin_height;
  const double pressure = flow::drag_pressure(flow::DragBody::blades,
                                              0.5 * (g.fin_top_width + g.fin_bottom_width), 2., {});
  // The wire's own share of the upper face does not look into the wind.
  EXPECT_NEAR(drag(sensor, 2.), pressure * area, 1e-3 * pressure * area);
}

TEST(WindSurface, ReversedWindReversesTheDragOfASymmetricSensor) {
  const Sensor sensor(flow_sensor(1));
  EXPECT_NEAR(drag(sensor, -2.), -drag(sensor, 2.), 1e-9 * drag(sensor, 2.));
}

TEST(WindSurface, CalmAirExertsNothing) {
  const Sensor sensor(flow_sensor(1));
  EXPECT_EQ(drag(sensor, 0.), 0.);
}

}  // namespace
}  // namespace vibrissa::fem
