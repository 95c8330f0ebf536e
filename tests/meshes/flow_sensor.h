#pragma once

#include "meshes/sensor_geometry.h"

namespace vibrissa::meshes {

/// The sensor of cases/flow_sensor.prm.
inline SensorGeometry flow_sensor() {
  SensorGeometry geometry;
  geometry.fin = FinShape::cross;
  geometry.free_length = 6.57e-3;
  return geometry;
}

}  // namespace vibrissa::meshes
