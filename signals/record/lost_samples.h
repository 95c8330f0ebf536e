#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vibrissa::signals {

/// Stamps of an evenly sampled device, with jitter.
struct JitteringStamps {
  std::span<const double> times_s;
  std::span<const double> samples;  // number of the sample of each stamp, without lost ones
  double period_s = 0.;             // within a few percent
  double jitter_s = 0.;             // standard deviation
  std::size_t quantum = 1;          // samples are lost in multiples of it: the size of a packet
};

/// How many samples are lost before each stamp: the most probable sequence of losses under normal
/// jitter, a phase and a period that are tracked, and a loss before one stamp in some hundred (a
/// Viterbi search over the number of losses with a tracker for each path, Raheli, Polydoros and
/// Tzou, IEEE Transactions on Communications 43, 1995). A single late stamp is no loss. Proven by
/// tests/signals/record/clock_test.cc.
std::vector<std::uint32_t> lost_before_each(const JitteringStamps& stamps);

}  // namespace vibrissa::signals
