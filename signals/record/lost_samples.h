#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vibrissa::signals {

/// Stamps of an evenly sampled device, with jitter.
struct JitteringStamps {
  std::span<const double> times_s;
  std::span<const double> samples;  // of each stamp, without lost ones; empty: 0, 1, 2, ...
  double period_s = 0.;             // within a few percent
  double jitter_s = 0.;             // standard deviation
  std::size_t quantum = 1;          // samples are lost in multiples of it: the size of a packet

  /// Samples from the stamp before to this one.
  double steps(std::size_t i) const { return samples.empty() ? 1. : samples[i] - samples[i - 1]; }
};

/// Samples that are lost before a stamp.
struct Loss {
  std::size_t stamp = 0;
  std::uint32_t count = 0;
  bool operator==(const Loss&) const = default;
};

/// Where samples are lost, in the order of the stamps: the most probable sequence of losses under
/// normal jitter, a phase and a period that are tracked, and a loss before one stamp in some
/// hundred (a Viterbi search over the number of losses with a tracker for each path, Raheli,
/// Polydoros and Tzou, IEEE Transactions on Communications 43, 1995). A single late stamp is no
/// loss. Proven by tests/signals/record/clock_test.cc.
std::vector<Loss> find_losses(const JitteringStamps& stamps);

}  // namespace vibrissa::signals
