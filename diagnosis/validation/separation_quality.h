#pragma once

#include <optional>

#include "diagnosis/model/updated_model.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Signal-to-distortion ratio [dB] (separation/metrics/metrics.h) of the wind moment in held-out
/// records: the measured moment minus the predicted vibration, compared with the true wind moment
/// (channel wind_moment_N_m).
struct SeparationQuality {
  double before_db = 0.;  // prediction by the simulation
  double after_db = 0.;   // prediction by the updated model
};

/// Over all held-out records with base motion, wind and the true wind moment; nothing when there
/// are none. Proven by tests/diagnosis/validation/separation_quality_test.cc.
std::optional<SeparationQuality> separation_quality(const UpdatedModel& simulation,
                                                    const UpdatedModel& updated,
                                                    const signals::Dataset& real);

}  // namespace vibrissa::diagnosis
