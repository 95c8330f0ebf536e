#pragma once

#include <optional>

#include "diagnosis/model/updated_model.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Root mean square error [m/s] of the wind speed that is read from held-out records: the measured
/// moment less the vibration that a simulation predicts for the base's motion, by the steady drag
/// law M = W u |u| of that simulation, against the measured wind; both averaged over four periods
/// of the first mode.
struct WindSpeedError {
  double before_m_s = 0.;  // by the simulation as it is
  double after_m_s = 0.;   // updated
};

/// Over all held-out records with a measured wind; nothing where there is none, or where a
/// simulation has no steady response to wind. Proven by
/// tests/diagnosis/validation/wind_speed_error_test.cc.
std::optional<WindSpeedError> wind_speed_error(const UpdatedModel& simulation,
                                               const UpdatedModel& updated,
                                               const signals::Dataset& real);

}  // namespace vibrissa::diagnosis
