#pragma once

#include <filesystem>

#include "signals/model/beam_model.h"
#include "signals/model/reduced_model.h"

namespace vibrissa::reproduction {

/// The flow sensor of the reference paper, twice.
struct FlowSensors {
  signals::ReducedModel simulated;  // from its case
  /// The built flow sensor, of which only published parameters exist: the simulated one with its
  /// first pair of modes at 31.47 Hz and a damping ratio of 0.027, all other parameters unchanged.
  signals::ReducedModel built;
};

/// Solves the case. Throws UserError for a case that does not describe a sensor.
FlowSensors make_flow_sensors(const std::filesystem::path& flow_case, bool show_progress);

/// The three sensors of the reference paper, and its analytical beam.
struct PaperSensors {
  signals::ReducedModel flow, whisker;  // simulated, from their cases
  signals::ReducedModel built;          // see FlowSensors
  signals::Beam wire;                   // the whisker's free wire, clamped rigidly
};

inline constexpr double built_frequency_hz = 31.47, built_damping_ratio = 0.027;

/// Solves both cases. Throws UserError for a case that does not describe a sensor.
PaperSensors make_paper_sensors(const std::filesystem::path& flow_case,
                                const std::filesystem::path& whisker_case, bool show_progress);

}  // namespace vibrissa::reproduction
