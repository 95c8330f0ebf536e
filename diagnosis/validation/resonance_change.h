#pragma once

#include <optional>

#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// Peak frequency of the response to base acceleration, and its gain well below the peak: of the
/// simulation and of the updated model.
struct ResonanceChange {
  double simulated_hz = 0., measured_hz = 0.;
  double slow_gain_ratio = 1.;  // measured / simulated, at a fifth of the simulated peak frequency
};

/// fitted: the updated model. Peaks are searched between a fifth and four times the first mode's
/// frequency, below half the highest sampling rate. Nothing without a mode, without base motion, or
/// without a peak. Proven by tests/diagnosis/validation/resonance_change_test.cc.
std::optional<ResonanceChange> resonance_change(const Experiment& experiment,
                                                const UpdatedModel& fitted);

}  // namespace vibrissa::diagnosis
