#pragma once

#include <filesystem>

#include "signals/beam_model.h"
#include "signals/reduced_model.h"

namespace vibrissa::apps {

/// The three sensors of the reference paper, and its analytical beam.
struct PaperSensors {
  signals::ReducedModel flow, whisker;  // simulated, from their cases
  /// Stands for the built flow sensor, which exists only on paper: the simulated one with its first
  /// pair moved to 31.47 Hz and a damping ratio of 0.027, its other figures left.
  signals::ReducedModel built;
  signals::Beam wire;  // the whisker's free wire, clamped rigidly
};

inline constexpr double built_frequency_hz = 31.47, built_damping_ratio = 0.027;

/// Solves both cases. Throws UserError for a case that does not describe a sensor.
PaperSensors make_paper_sensors(const std::filesystem::path& flow_case,
                                const std::filesystem::path& whisker_case, bool show_progress);

}  // namespace vibrissa::apps
