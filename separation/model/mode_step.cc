#include "separation/model/mode_step.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vibrissa::separation {

namespace {

Sensitive operator+(const Sensitive& x, const Sensitive& y) {
  return {x.value + y.value, x.by_a1 + y.by_a1, x.by_a0 + y.by_a0};
}
Sensitive operator-(const Sensitive& x, const Sensitive& y) {
  return {x.value - y.value, x.by_a1 - y.by_a1, x.by_a0 - y.by_a0};
}
Sensitive operator*(const Sensitive& x, const Sensitive& y) {
  return {x.value * y.value, x.by_a1 * y.value + x.value * y.by_a1,
          x.by_a0 * y.value + x.value * y.by_a0};
}
Sensitive operator*(double c, const Sensitive& x) {
  return {c * x.value, c * x.by_a1, c * x.by_a0};
}
Sensitive operator-(const Sensitive& x) {
  return -1. * x;
}

constexpr Sensitive one{1., 0., 0.};

using Column = std::array<Sensitive, 2>;  // of the state (x, x')

Column operator+(const Column& x, const Column& y) {
  return {x[0] + y[0], x[1] + y[1]};
}
Column operator-(const Column& x, const Column& y) {
  return {x[0] - y[0], x[1] - y[1]};
}
Column operator*(double c, const Column& x) {
  return {c * x[0], c * x[1]};
}

struct Matrix {
  Sensitive xx, xv, vx, vv;
};

Column operator*(const Matrix& m, const Column& c) {
  return {m.xx * c[0] + m.xv * c[1], m.vx * c[0] + m.vv * c[1]};
}

// State of x'' + a1 x' + a0 x = u after a time t: free motion, and from rest for u = 1 and u = t.
struct Motion {
  Matrix free;
  Column step, ramp;
};

Motion motion_after(double a1, double a0, double t) {
  const double half = 0.5 * a1;
  const double fastest_pole = t * (std::abs(half) + std::sqrt(std::abs(half * half - a0)));
  int n_doublings = 0;
  std::frexp(fastest_pole, &n_doublings);
  n_doublings = std::max(0, n_doublings);
  const double first = std::ldexp(t, -n_doublings);
  Sensitive damping{a1 * first, first, 0.}, stiffness{a0 * first * first, 0., first * first};

  // Taylor series of the response to a ramp; its derivatives are the responses to a step and an
  // impulse.
  constexpr int n_terms = 24;
  std::array<Sensitive, n_terms> term{};
  term[3].value = 1. / 6.;
  Sensitive ramp = term[3], step = 3. * term[3], impulse = 6. * term[3];
  for (int k = 4; k < n_terms; ++k) {
    term[k] =
        (-1. / (k * (k - 1))) * ((k - 1.) * (damping * term[k - 1]) + stiffness * term[k - 2]);
    ramp = ramp + term[k];
    step = step + static_cast<double>(k) * term[k];
    impulse = impulse + static_cast<double>(k * (k - 1)) * term[k];
  }
  const auto free_motion = [&] {
    const Sensitive xx = one - stiffness * step;
    return Matrix{xx, impulse, -(stiffness * impulse), xx - damping * impulse};
  };
  for (int i = 0; i < n_doublings; ++i) {
    const Matrix free = free_motion();
    ramp = 0.125 * (free.xx * ramp + free.xv * step + step + ramp);
    const Column twice = free * Column{step, impulse} + Column{step, impulse};
    step = 0.25 * twice[0];
    impulse = 0.5 * twice[1];
    damping = 2. * damping;
    stiffness = 4. * stiffness;
  }
  const Matrix scaled = free_motion();
  return {.free = {scaled.xx, t * scaled.xv, (1. / t) * scaled.vx, scaled.vv},
          .step = {(t * t) * step, t * impulse},
          .ramp = {(t * t * t) * ramp, (t * t) * step}};
}

// One output (x or x') at a time between two samples: of the state at the older one, and directly
// of the inputs at both.
struct OutputRow {
  Sensitive x, v;
  Sensitive sooner, later;
  Sensitive operator*(const Column& c) const { return x * c[0] + v * c[1]; }
};

// How the state at the next sample depends on the input now, half a sample later, and then.
struct InputGain {
  Column old_node, midpoint, new_node;
};

InputGain input_gain(double a1, double a0, double t, const Motion& whole, Hold hold) {
  if (hold == Hold::zero_order) return {.old_node = whole.step, .midpoint = {}, .new_node = {}};
  if (hold == Hold::first_order) {
    const Column later = (1. / t) * whole.ramp;
    return {.old_node = whole.step - later, .midpoint = {}, .new_node = later};
  }
  const Motion half = motion_after(a1, a0, 0.5 * t);
  const Column later = (2. / t) * half.ramp;
  const Column sooner = half.step - later;
  return {
      .old_node = half.free * sooner, .midpoint = half.free * later + sooner, .new_node = later};
}

// The outputs x and x' at a fraction of a step before the sample n, from the state at n - 1.
std::array<OutputRow, 2> rows_between(double a1, double a0, double t, double fraction, Hold hold) {
  const double remaining = (1. - fraction) * t;
  const Motion part = motion_after(a1, a0, remaining);
  const Column later = hold == Hold::zero_order ? Column{} : (1. / t) * part.ramp;
  const Column sooner = part.step - later;
  return {OutputRow{part.free.xx, part.free.xv, sooner[0], later[0]},
          OutputRow{part.free.vx, part.free.vv, sooner[1], later[1]}};
}

constexpr std::array<OutputRow, 2> rows_at_sample{OutputRow{one, {}, {}, {}},
                                                  OutputRow{{}, one, {}, {}}};

}  // namespace

SampledDelay sampled_delay(double delay_s, double sampling_rate_hz) {
  const double samples = delay_s * sampling_rate_hz;
  // A delay that is a whole number of samples but for rounding shall be one.
  const double nearest = std::round(samples);
  if (std::abs(samples - nearest) < 1e-9 * std::max(1., std::abs(nearest)))
    return {static_cast<std::ptrdiff_t>(nearest), 0.};
  const double whole = std::floor(samples);
  return {static_cast<std::ptrdiff_t>(whole), samples - whole};
}

ModeStep::ModeStep(double a1, double a0, double sampling_rate_hz, Hold hold, double fraction) {
  assert(a1 > 0. && a0 > 0. && fraction >= 0. && fraction < 1.);
  assert(fraction == 0. || hold != Hold::band_limited);
  const double t = 1. / sampling_rate_hz;
  const Motion whole = motion_after(a1, a0, t);
  const Matrix& free = whole.free;
  pole1 = -(free.xx + free.vv);
  const double decay = std::exp(-a1 * t);
  pole2 = {decay, -t * decay, 0.};

  const InputGain gain = input_gain(a1, a0, t, whole, hold);
  const Matrix other{free.vv, -free.xv, -free.vx, free.xx};  // trace * identity - free
  const std::array<Column, 3> node{gain.new_node, gain.old_node - other * gain.new_node,
                                   -1. * (other * gain.old_node)};
  for (std::size_t j = 0; j < 3; ++j) state_taps[j] = {node[j][0].value, node[j][1].value};

  const bool between = fraction > 0.;
  const std::size_t late = between ? 1 : 0;
  const std::array<OutputRow, 2> rows =
      between ? rows_between(a1, a0, t, fraction, hold) : rows_at_sample;
  for (const bool rate : {false, true}) {
    const OutputRow& row = rows[rate ? 1 : 0];
    auto& taps = rate ? b1_taps : b0_taps;
    auto& mid = rate ? b1_mid : b0_mid;
    auto& rest = rate ? b1_rest : b0_rest;
    for (std::size_t j = 0; j < 3; ++j) taps[j + late] = row * node[j];
    if (between) {
      taps[0] = taps[0] + row.later;
      taps[1] = taps[1] + row.sooner + row.later * pole1;
      taps[2] = taps[2] + row.sooner * pole1 + row.later * pole2;
      taps[3] = taps[3] + row.sooner * pole2;
    }
    mid[1] = row * gain.midpoint;
    mid[2] = -(row * (other * gain.midpoint));
    rest[late] = -(row * gain.new_node);
    rest[late + 1] = row * (other * gain.new_node);
  }
}

}  // namespace vibrissa::separation
