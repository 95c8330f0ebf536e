#pragma once

#include <deal.II/base/parameter_handler.h>

#include "fem/sensor/sensor.h"

namespace vibrissa::fem {

/// The sensors of the test cases: dimensions as in cases/, any mesh resolution.
inline SensorParameters default_sensor() {
  dealii::ParameterHandler prm;
  SensorParameters parameters;
  meshes::SensorGeometry::declare(prm);
  materials::SensorMaterials::declare(prm);
  ModelParameters::declare(prm);
  flow::WindParameters::declare(prm);
  parameters.geometry.parse(prm);
  parameters.materials.parse(prm);
  parameters.model.parse(prm);
  parameters.wind.parse(prm);
  return parameters;
}

inline SensorParameters whisker_sensor(const unsigned int resolution) {
  SensorParameters parameters = default_sensor();
  parameters.model.mesh_resolution = resolution;
  return parameters;
}

inline SensorParameters flow_sensor(const unsigned int resolution) {
  SensorParameters parameters = whisker_sensor(resolution);
  parameters.geometry.fin = meshes::FinShape::cross;
  parameters.geometry.free_length = 6.57e-3;
  return parameters;
}

}  // namespace vibrissa::fem
