#pragma once

#include "fem/sensor/sensor.h"
#include "signals/model/reduced_model.h"

namespace vibrissa::sensor_case {

/// The reduced model of a solved sensor with its sensitivities when the case asks for them, and its
/// provenance (program revision, mesh hash). A progress bar shows the further solutions.
signals::ReducedModel make_reduced_model(const fem::Sensor& sensor,
                                         const fem::SensorParameters& parameters,
                                         bool show_progress);

}  // namespace vibrissa::sensor_case
