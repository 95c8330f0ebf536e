#pragma once

#include <optional>

#include "diagnosis/model/updated_model.h"
#include "diagnosis/validation/held_out.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Rms error [m/s] of the wind speed estimated from held-out records with measured wind: the
/// measured moment minus the predicted vibration, converted by the simulation's steady drag law M =
/// W u |u|, compared with the measured wind speed; both are averaged over four periods of the first
/// mode. Nothing without such records, or when the simulation has no steady response to wind.
/// Proven by tests/diagnosis/validation/wind_speed_error_test.cc.
std::optional<BeforeAfter> wind_speed_error_m_s(const UpdatedModel& simulation,
                                                const UpdatedModel& updated,
                                                const signals::Dataset& real);

/// Signal-to-distortion ratio [dB] (separation/metrics/metrics.h) of the wind moment: the measured
/// moment minus the predicted vibration, compared with the true wind moment (channel
/// wind_moment_N_m), over all held-out records with base motion, wind and that channel. Nothing
/// when there are none. Proven by tests/diagnosis/validation/separation_quality_test.cc.
std::optional<BeforeAfter> separation_sdr_db(const UpdatedModel& simulation,
                                             const UpdatedModel& updated,
                                             const signals::Dataset& real);

}  // namespace vibrissa::diagnosis
