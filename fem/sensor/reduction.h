#pragma once

#include "fem/sensor/sensor.h"
#include "signals/model/reduced_model.h"

namespace vibrissa::fem {

/// The sensor's modes with the static correction for base acceleration and wind (reduced_model.h),
/// without sensitivities. The wind table spans -40 .. 40 m/s.
signals::ReducedModel reduce(const Sensor& sensor);

}  // namespace vibrissa::fem
