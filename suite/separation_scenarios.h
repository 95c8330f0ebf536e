#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "signals/model/reduced_model.h"
#include "signals/record/record.h"

namespace vibrissa::suite {

/// A record to separate, with the truth behind it.
struct Scenario {
  std::string name, about;
  signals::Record record;                    // with base vibration and stimulus
  std::vector<double> true_wind_moment_n_m;  // empty: unknown
  /// A record of the same rig without stimulus, to identify from; nothing: none was made.
  std::optional<signals::Record> vibration_only;
};

/// What the suite simulates its scenarios with: the built sensor at 500 Hz with the noise of its
/// accelerometer and Hall element, unless a scenario says otherwise.
struct ScenarioRig {
  signals::ReducedModel sensor, simulated_sensor;  // the latter for the paper's simulation
  double duration_s = 40.;
  std::uint64_t seed = 1;
  std::filesystem::path recordings;  // folder of recorded vibration and wind; empty: none
};

/// All scenarios; those that need recordings are left out, with a line each in `left_out`, when a
/// file is missing. Throws UserError for a recording that cannot be read.
std::vector<Scenario> make_scenarios(const ScenarioRig& rig, std::vector<std::string>& left_out);

/// Base moment of a sensor whose first resonance drifts linearly in time to last_hz over the
/// record; at rest at its first sample, its other modes fixed [N m]. Exact for a frequency that is
/// constant from sample to sample. Proven by tests/suite/separation_scenarios_test.cc.
std::vector<double> drifting_moment(const signals::ReducedModel& model, double last_hz,
                                    const std::vector<double>& base_acceleration_m_s2,
                                    double sampling_rate_hz);

}  // namespace vibrissa::suite
