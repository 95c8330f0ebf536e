#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "signals/files/dataset.h"
#include "trial/plant/motion.h"
#include "trial/plant/world.h"

namespace vibrissa::trial {

/// One record of a session on the bench.
struct Take {
  std::string name{};
  double base_rms = 0.;   // m/s^2; 0: the stage is at rest
  double wind_mean = 0.;  // m/s; 0: the fan is off
  std::size_t n_samples = 0, period_samples = 0;
  signals::Split split = signals::Split::fit;
  std::uint64_t drive = 0;  // takes with the same number are driven alike
  double low_hz = 3., high_hz = 110.;
  double gustiness = 0.35;  // turbulence intensity of the wind

  bool is_at_rest() const { return base_rms == 0. && wind_mean == 0.; }
};

/// At rest, two levels, the higher one twice, wind, both; two more are held out.
std::vector<Take> usual_takes();
/// Two thirds less of all, for motions that take long to compute: at rest, two levels, wind, both;
/// one more is held out.
std::vector<Take> short_takes();
/// Another level and another wind, to see how far an answer carries.
std::vector<Take> transfer_takes();

/// What the bench can do besides, under the names of the menu of experiments that are recommended.
struct FurtherExperiment {
  std::string name;
  std::vector<Take> takes;
};
std::vector<FurtherExperiment> further_experiments();

struct Session {
  std::vector<Take> takes;
  std::uint64_t seed = 1;
  bool noise = true;
};

/// The records that the bench writes of a sensor that moves so; both sensors sample that on their
/// own clocks.
signals::Dataset record_session(Motion& motion, const Structure& structure, const World& world,
                                const Session& session);
/// By the modes.
signals::Dataset record_session(const Structure& structure, const World& world,
                                const Session& session);

}  // namespace vibrissa::trial
