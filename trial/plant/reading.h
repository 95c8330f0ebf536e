#pragma once

#include <cstdint>
#include <vector>

#include "signals/record/record.h"
#include "trial/plant/world.h"

namespace vibrissa::trial {

/// True signals on the bench on the fine time grid; the record begins at time 0.
struct FineRecord {
  const std::vector<double>&acceleration, &across, &wind, &moment;
  double rate_hz = 0., first_s = 0.;
};

struct Readings {
  bool noise = true;
  bool wind = true;  // the channel of the wind speed
};

/// Readings of accelerometer, probe and moment sensor, each with its own electronics and clock.
signals::Record read_out(const World& world, const Structure& structure, const FineRecord& fine,
                         std::size_t n, double rate_hz, std::uint64_t seed,
                         const Readings& readings);

}  // namespace vibrissa::trial
