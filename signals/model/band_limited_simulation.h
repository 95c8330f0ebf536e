#pragma once

#include "signals/model/reduced_model.h"

namespace vibrissa::signals {

/// As simulate(), for inputs that are band-limited between their samples, which is how a sampled
/// recording of a true motion is to be read: resampled (resample.h, flat to 0.4975 of the rate) to
/// straight lines of a sixteenth of the sampling interval, of which a mode feels a line at f Hz too
/// little by (pi f / (16 rate))^2 / 3: 0.3 % at half the rate, 0.01 % at a tenth. Throws as
/// simulate(). Proven by
/// tests/signals/model/band_limited_simulation_test.cc against base_response().
ReducedOutput simulate_band_limited(const ReducedModel& model, const ReducedInput& input);

}  // namespace vibrissa::signals
