#pragma once

#include <cstdint>
#include <string>

#include "diagnosis/checks/finding.h"
#include "signals/record/record.h"

namespace vibrissa::checks::test {

/// Drives of good records.
enum class Drive { random, multisine, sweep, hits };

/// A drawn sensor (one to three modes), rate and level, with noise of both channels 20 to 60 dB
/// below the signals (40 to 60 dB for hits), an offset, and in some records converter steps, weak
/// hum and weak drift. Everything follows from the seed.
signals::Record good_record(Drive drive, std::uint64_t seed);

enum class Fault {
  dead_moment,
  dead_acceleration,
  clipped,
  drive_ended,
  swapped,
  aliased,
  one_hit,
  noise_alone,
  changing,
  no_input,
  hum_only,
  few_steps,
  too_short,
  opposite_sign,
  unit_factor
};
inline constexpr std::size_t n_faults = 15;

/// A record of the same sensors with one fault, and what must be found.
struct BadRecord {
  std::string name;
  signals::Record record;
  diagnosis::FindingKind expected;
  bool stops_identify = false;  // else something is missing or doubtful
};
BadRecord bad_record(Fault fault, std::uint64_t seed);

}  // namespace vibrissa::checks::test
