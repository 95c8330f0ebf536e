#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "fem/sensor/sensor.h"
#include "signals/model/reduced_model.h"

namespace vibrissa::fem {

/// Relative sensitivities of the reduced model's figures by central differences of whole solutions
/// (step 0.1 %), for moduli, density and lengths that the sensor has. The k-th
/// mode is compared with the k-th; progress is called after each solution.
std::vector<signals::Sensitivity> sensitivities(
    const SensorParameters& parameters, const signals::ReducedModel& nominal,
    const std::function<void()>& progress = [] {});

/// Number of solutions that sensitivities() makes for this sensor.
std::size_t n_sensitivity_solutions(const SensorParameters& parameters);

}  // namespace vibrissa::fem
