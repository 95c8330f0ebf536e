#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vibrissa::signals {

/// Where a window of one signal lies in another one, both at one nominal rate.
struct MatchedWindow {
  double at = 0.;      // first sample of the window in its own signal
  double found = 0.;   // the same in the other signal, between samples
  double weight = 0.;  // inverse variance [1/samples^2]
};

struct SharedMotionSearch {
  double largest_drift = 1e-3;  // of a crystal with a wide margin
  double lobe_samples = 4.;     // matches closer than this are one
};

/// Windows of `pattern` that are found in `signal`, all with one sign, at places that a drift of
/// the clocks allows. Both are whitened, so that the correlation has one narrow peak. A window of
/// correlation r says n log(1 - r^2) / -2 for its place, n the effective number of samples from the
/// median correlation at all other places. Empty unless the best places are a thousand times as
/// likely as any others, beyond five deviations of what the noise at two repetitions of one motion
/// differs by. Proven by tests/signals/spectra/clock_relation_test.cc.
struct SharedMotionMatch {
  std::vector<MatchedWindow> windows;
  bool is_opposite = false;
};
SharedMotionMatch find_shared_motion(std::span<const double> signal,
                                     std::span<const double> pattern,
                                     const SharedMotionSearch& search);

}  // namespace vibrissa::signals
