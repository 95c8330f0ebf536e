#pragma once

#include <optional>

#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// Where the reading per base acceleration peaks, and how large it is well below: of the simulation
/// as it is, and as the records have it.
struct ResonanceChange {
  double simulated_hz = 0., measured_hz = 0.;
  double slow_gain_ratio = 1.;  // measured over simulated, at a fifth of the simulated peak
};

/// fitted: the simulation with what was fitted to the experiment's records. Peaks are sought
/// between a fifth and four times the first mode's frequency, below half the fastest rate. Nothing
/// without a mode, without base motion, or where nothing peaks there. Proven by
/// tests/diagnosis/validation/resonance_change_test.cc.
std::optional<ResonanceChange> resonance_change(const Experiment& experiment,
                                                const UpdatedModel& fitted);

}  // namespace vibrissa::diagnosis
