#pragma once

#include "signals/model/reduced_model.h"

namespace vibrissa::signals {

/// As simulate(), for inputs that are band-limited between their samples, as in a sampled recording
/// of a true motion. The input is resampled (resample.h, flat to 0.4975 of the rate) to 16 times
/// the rate and is linear between these samples. The amplitude at f Hz is then too low by the share
/// (pi f / (16 rate))^2 / 3: 0.3 % at half the rate, 0.01 % at a tenth of it. Throws as simulate().
/// Proven by tests/signals/model/band_limited_simulation_test.cc against base_response().
ReducedOutput simulate_band_limited(const ReducedModel& model, const ReducedInput& input);

}  // namespace vibrissa::signals
