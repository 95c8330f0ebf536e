#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "fem/sensor/sensor.h"
#include "signals/model/reduced_model.h"

namespace vibrissa::fem {

/// Relative sensitivities of the modal properties of the reduced model to the moduli, densities and
/// lengths of the sensor, by central differences of complete solutions (step 0.1 %). Mode k is
/// compared with mode k; progress is called after each solution.
std::vector<signals::Sensitivity> sensitivities(
    const SensorParameters& parameters, const signals::ReducedModel& nominal,
    const std::function<void()>& progress = [] {});

/// Number of solutions that sensitivities() makes for this sensor.
std::size_t n_sensitivity_solutions(const SensorParameters& parameters);

}  // namespace vibrissa::fem
