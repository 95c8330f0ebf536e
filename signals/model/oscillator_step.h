#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace vibrissa::signals {

/// Exact step h of q'' + 2 zeta w q' + w^2 q = f with f linear over the step (first-order hold),
/// for the scaled state Q = q / h^2, P = q' / h:
///   Q1 = Q + (qq Q + qp P + q_old f0 + q_new f1),  P1 = P + (pq Q + pp P + p_old f0 + p_new f1),
///   w^2 q + 2 zeta w q' = stiffness Q + damping P.
/// The equations give the changes instead of the new values, so that steps much shorter than a
/// period keep all digits. Any zeta >= 0 and w h > 0; proven by
/// tests/signals/model/oscillator_step_test.cc against closed forms.
struct OscillatorStep {
  double qq, qp, pq, pp;
  double q_old, q_new, p_old, p_new;
  double stiffness, damping;  // (w h)^2, 2 zeta w h
};

/// From w h [rad] and zeta. The responses of the oscillator at rest to a ramp, a step and an
/// impulse are power series over a step that is short enough to avoid cancellation; then the step
/// is doubled repeatedly.
inline OscillatorStep make_oscillator_step(double angle, double damping_ratio) {
  assert(angle > 0. && damping_ratio >= 0.);
  const double excess = std::max(0., damping_ratio * damping_ratio - 1.);
  const double fastest_pole = angle * (std::max(1., damping_ratio) + std::sqrt(excess));
  int n_doublings = 0;
  std::frexp(fastest_pole, &n_doublings);
  n_doublings = std::max(0, n_doublings);
  double x = std::ldexp(angle, -n_doublings);
  double beta = 2. * damping_ratio * x;

  // r'' + beta r' + x^2 r = t; its derivatives are the responses to a step and an impulse.
  constexpr int n_terms = 24;
  std::array<double, n_terms> r{};
  double ramp = 0., step = 0., impulse = 0.;
  for (int k = 3; k < n_terms; ++k) {
    const double source = k == 3 ? 1. : 0.;
    r[k] = (source - beta * (k - 1) * r[k - 1] - x * x * r[k - 2]) / (k * (k - 1));
    ramp += r[k];
    step += k * r[k];
    impulse += k * (k - 1) * r[k];
  }
  for (int i = 0; i < n_doublings; ++i) {
    const double qq = -x * x * step, pq = -x * x * impulse, pp = qq - beta * impulse;
    ramp = (qq * ramp + impulse * step + 2. * ramp + step) / 8.;
    const double twice = (qq * step + impulse * impulse + 2. * step) / 4.;
    impulse = (pq * step + pp * impulse + 2. * impulse) / 2.;
    step = twice;
    x *= 2.;
    beta *= 2.;
  }
  const double qq = -x * x * step;
  return {.qq = qq,
          .qp = impulse,
          .pq = -x * x * impulse,
          .pp = qq - beta * impulse,
          .q_old = step - ramp,
          .q_new = ramp,
          .p_old = impulse - step,
          .p_new = step,
          .stiffness = x * x,
          .damping = beta};
}

}  // namespace vibrissa::signals
