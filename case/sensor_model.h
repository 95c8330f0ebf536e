#pragma once

#include "fem/sensor/sensor.h"
#include "signals/model/reduced_model.h"

namespace vibrissa::sensor_case {

/// The reduced model of a solved sensor, with its provenance (program revision, mesh hash) and,
/// when the case requests them, its sensitivities. A progress bar shows the solutions for the
/// sensitivities.
signals::ReducedModel make_reduced_model(const fem::Sensor& sensor,
                                         const fem::SensorParameters& parameters,
                                         bool show_progress);

}  // namespace vibrissa::sensor_case
