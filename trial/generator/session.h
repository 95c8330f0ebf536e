#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "signals/files/dataset.h"
#include "trial/plant/motion.h"
#include "trial/plant/world.h"

namespace vibrissa::trial {

/// One record (take) of a session on the bench.
struct Take {
  std::string name{};
  double base_rms = 0.;   // m/s^2; 0: the stage is at rest
  double wind_mean = 0.;  // m/s; 0: the fan is off
  std::size_t n_samples = 0, period_samples = 0;
  signals::Split split = signals::Split::fit;
  std::uint64_t drive = 0;  // takes with the same number have the same excitation
  double low_hz = 3., high_hz = 110.;
  double gustiness = 0.35;  // turbulence intensity of the wind

  bool is_at_rest() const { return base_rms == 0. && wind_mean == 0.; }
  bool operator==(const Take&) const = default;
};

/// The usual session: at rest, two levels (the higher one twice), wind, both; and two held-out
/// takes.
std::vector<Take> usual_takes();
/// A session of a third of the length, for motions that are slow to compute: at rest, two levels,
/// wind, both; and one held-out take.
std::vector<Take> short_takes();
/// Held-out takes at another level and another wind, for cross-validation.
std::vector<Take> transfer_takes();

/// Further experiments of the bench, with the names of the menu of recommended experiments.
struct FurtherExperiment {
  std::string name;
  std::vector<Take> takes;
};
std::vector<FurtherExperiment> further_experiments();

struct Session {
  std::vector<Take> takes;
  std::uint64_t seed = 1;
  bool noise = true;
  bool has_wind_channel = true;
};

/// The records that the bench writes for a sensor with this motion; accelerometer and moment sensor
/// have their own clocks.
signals::Dataset record_session(Motion& motion, const Structure& structure, const World& world,
                                const Session& session);
/// The same with the motion of the modes.
signals::Dataset record_session(const Structure& structure, const World& world,
                                const Session& session);

}  // namespace vibrissa::trial
