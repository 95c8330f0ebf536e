#pragma once

#include <array>
#include <cstddef>

#include "separation/model/input_hold.h"
#include "separation/model/rational_model.h"

namespace vibrissa::separation {

/// A number with its derivatives with respect to the pole parameters of a mode.
struct Sensitive {
  double value = 0.;
  double by_a1 = 0.;
  double by_a0 = 0.;
};

/// Position of an output sample between the input samples: delay = (shift + fraction) / rate, 0 <=
/// fraction < 1.
struct SampledDelay {
  std::ptrdiff_t shift = 0;
  double fraction = 0.;
};
SampledDelay sampled_delay(double delay_s, double sampling_rate_hz);

/// Exact difference equation of 1 / (s^2 + a1 s + a0) and s / (s^2 + a1 s + a0) on a uniform grid,
/// for an input with the given hold. With
///   v[n] = u[n] - pole1 v[n-1] - pole2 v[n-2],  u the nodes of the shaped input,
/// and w the same of its midpoints (band_limited only), the output at (n - fraction) / rate is
///   sum_j (b0 b0_taps[j] + b1 b1_taps[j]) v[n-j] + sum_j (b0 b0_mid[j] + b1 b1_mid[j]) w[n-j]
/// plus a free response. g is v for a unit impulse; a free response is sum_j r[j] g[n-j], where r
/// spans two dimensions, r = (r0, r1, 0) when fraction is 0 and (0, r0, r1) otherwise. A mode at
/// rest at the first sample has r[j] = u[0] (b0 b0_rest[j] + b1 b1_rest[j]), because v with zero
/// initial memory implies an input that rises from zero one sample earlier. For band_limited the
/// fraction is part of the shaped input and must be 0 here. Method: power series over a step that
/// is short enough to avoid cancellation, then repeated doubling (as
/// signals/model/oscillator_step.h), with derivatives; valid for any damping ratio. Proven by
/// tests/separation/model/mode_step_test.cc.
struct ModeStep {
  Sensitive pole1, pole2;
  std::array<Sensitive, 4> b1_taps{}, b0_taps{};
  std::array<Sensitive, 3> b1_mid{}, b0_mid{};
  std::array<Sensitive, 3> b1_rest{}, b0_rest{};
  /// State (x, x') of 1 / (s^2 + a1 s + a0) at sample n: sum_j state_taps[j] v[n-j] (+ of w).
  std::array<std::array<double, 2>, 3> state_taps{};

  ModeStep(double a1, double a0, double sampling_rate_hz, Hold hold, double delay_fraction = 0.);
};

}  // namespace vibrissa::separation
