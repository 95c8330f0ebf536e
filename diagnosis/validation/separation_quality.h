#pragma once

#include <optional>

#include "diagnosis/model/updated_model.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Signal to distortion [dB] (separation/metrics/metrics.h) of the wind's moment in held-out
/// records: the measured moment less the vibration that a simulation predicts for the base's
/// motion, against the true one of channel wind_moment_N_m.
struct SeparationQuality {
  double before_db = 0.;  // by the simulation as it is
  double after_db = 0.;   // updated
};

/// Over all held-out records of base motion and wind that hold the truth; nothing where none does.
/// Proven by tests/diagnosis/validation/separation_quality_test.cc.
std::optional<SeparationQuality> separation_quality(const UpdatedModel& simulation,
                                                    const UpdatedModel& updated,
                                                    const signals::Dataset& real);

}  // namespace vibrissa::diagnosis
