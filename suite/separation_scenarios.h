#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "signals/model/reduced_model.h"
#include "signals/record/record.h"

namespace vibrissa::suite {

/// A record to separate, with its true wind moment.
struct Scenario {
  std::string name, about;
  signals::Record record;                    // with base vibration and stimulus
  std::vector<double> true_wind_moment_n_m;  // empty: unknown
  /// A record of the same rig without stimulus, for identification; nothing when there is none.
  std::optional<signals::Record> vibration_only;
};

/// Simulated rig of the suite: the built sensor at 500 Hz with the noise of its accelerometer and
/// Hall element, unless a scenario states otherwise.
struct ScenarioRig {
  signals::ReducedModel sensor, simulated_sensor;  // the latter for the paper's simulation
  double duration_s = 40.;
  std::uint64_t seed = 1;
  std::filesystem::path recordings;  // folder of recorded vibration and wind; empty: none
};

/// All scenarios. A scenario whose recording is missing is left out, with one line in left_out.
/// Throws UserError for a recording that cannot be read.
std::vector<Scenario> make_scenarios(const ScenarioRig& rig, std::vector<std::string>& left_out);

/// Base moment of a sensor whose first resonance drifts linearly in time to last_hz over the
/// record; at rest at its first sample, its other modes fixed [N m]. Exact for a frequency that is
/// constant between two samples. Proven by tests/suite/separation_scenarios_test.cc.
std::vector<double> drifting_moment(const signals::ReducedModel& model, double last_hz,
                                    const std::vector<double>& base_acceleration_m_s2,
                                    double sampling_rate_hz);

}  // namespace vibrissa::suite
