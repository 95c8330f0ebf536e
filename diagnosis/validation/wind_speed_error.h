#pragma once

#include <optional>

#include "diagnosis/model/updated_model.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Rms error [m/s] of the wind speed estimated from held-out records: the measured moment minus the
/// predicted vibration, converted by the simulation's steady drag law M = W u |u|, compared with
/// the measured wind speed; both are averaged over four periods of the first mode.
struct WindSpeedError {
  double before_m_s = 0.;  // by the simulation
  double after_m_s = 0.;   // by the updated model
};

/// Over all held-out records with measured wind; nothing when there are none, or when the
/// simulation has no steady response to wind. Proven by
/// tests/diagnosis/validation/wind_speed_error_test.cc.
std::optional<WindSpeedError> wind_speed_error(const UpdatedModel& simulation,
                                               const UpdatedModel& updated,
                                               const signals::Dataset& real);

}  // namespace vibrissa::diagnosis
