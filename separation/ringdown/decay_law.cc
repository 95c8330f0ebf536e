#include "separation/ringdown/decay_law.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vibrissa::separation {

namespace {

/// State of the friction after a motion in one direction, from z_before.
double friction_after(const DecayLaw& law, const double z_before, const double way) {
  if (!(law.slip > 0.)) return 0.;
  const double toward = way > 0. ? 1. : -1., rate = law.stick_ratio / law.slip;
  double z = toward * z_before, left = rate * std::abs(way);  // as if the motion were upward
  if (z < 0.) {
    // dz = (1 - reversal z) dx until the friction vanishes.
    const double r = law.reversal;
    const double to_zero = r > 0. ? std::log1p(-r * z) / r : -z;
    if (left < to_zero)
      return toward * (r > 0. ? (1. - (1. - r * z) * std::exp(-r * left)) / r : z + left);
    left -= to_zero;
    z = 0.;
  }
  return toward * (1. - (1. - z) * std::exp(-left));
}

/// Moment of the base; v = y' / w.
double total_moment(const DecayLaw& law, const double y, const double v, const double z) {
  return y + law.cubic * y * y * y + law.slip * z + 2. * law.damping_ratio * v +
         law.drag * std::abs(v) * v;
}

/// State in the angle w t as time.
struct State {
  double y = 0., v = 0., z = 0.;
};

void advance(const DecayLaw& law, State& s, const double h) {
  const auto pull = [&](double y, double v) {
    return -total_moment(law, y, v, friction_after(law, s.z, y - s.y));
  };
  const double a1 = -total_moment(law, s.y, s.v, s.z);
  const double v2 = s.v + 0.5 * h * a1, a2 = pull(s.y + 0.5 * h * s.v, v2);
  const double v3 = s.v + 0.5 * h * a2, a3 = pull(s.y + 0.5 * h * v2, v3);
  const double v4 = s.v + h * a3, a4 = pull(s.y + h * v3, v4);
  const double y = s.y + h / 6. * (s.v + 2. * (v2 + v3) + v4);
  s.v += h / 6. * (a1 + 2. * (a2 + a3) + a4);
  s.z = friction_after(law, s.z, y - s.y);
  s.y = y;
}

/// State of the friction at the upper end of a cycle that repeats itself: at the lower end it is
/// the negative.
double friction_at_turn(const DecayLaw& law, const double amplitude) {
  constexpr int n_halvings = 50;
  double low = 0., high = 1.;
  for (int i = 0; i < n_halvings; ++i) {
    const double z = 0.5 * (low + high);
    (friction_after(law, z, -2. * amplitude) + z < 0. ? low : high) = z;
  }
  return 0.5 * (low + high);
}

}  // namespace

std::vector<double> decay(const DecayLaw& law, const DecayStart& start, const std::size_t n,
                          const double sampling_rate_hz) {
  constexpr double largest_step_rad = 0.15;  // frequency right to 4e-6
  const double angle = 2. * std::numbers::pi * law.frequency_hz / sampling_rate_hz;
  const auto n_steps = static_cast<int>(std::ceil(angle / largest_step_rad));
  State state{.y = start.moment, .v = start.rate, .z = start.friction};
  std::vector<double> out;
  out.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(n);
    out.push_back(start.offset + start.drift * part + total_moment(law, state.y, state.v, state.z));
    for (int k = 0; k < n_steps; ++k) advance(law, state, angle / n_steps);
  }
  return out;
}

EquivalentMode equivalent_mode(const DecayLaw& law, const double amplitude) {
  constexpr int n = 400;  // steps of a cycle
  const double turn = 2. * std::numbers::pi / n;
  const auto y_at = [&](int i) { return amplitude * std::cos(turn * i); };
  const auto v_at = [&](int i, double ratio) { return -ratio * amplitude * std::sin(turn * i); };
  // Fundamentals of the elastic and frictional moment.
  double in_phase = 0., friction = 0., drag = 0., z = friction_at_turn(law, amplitude);
  for (int i = 0; i < n; ++i) {
    const double cosine = std::cos(turn * i), sine = std::sin(turn * i), y = y_at(i);
    if (i > 0) z = friction_after(law, z, y - y_at(i - 1));
    in_phase += 2. / n * (y + law.cubic * y * y * y + law.slip * z) * cosine;
    friction -= 2. / n * law.slip * z * sine;
  }
  const double ratio = std::sqrt(std::max(0., in_phase / amplitude));
  for (int i = 0; i < n; ++i) {
    const double v = v_at(i, ratio);
    drag -= 2. / n * law.drag * std::abs(v) * v * std::sin(turn * i);
  }
  const double viscous = 2. * law.damping_ratio * ratio * amplitude,
               loss = viscous + drag + friction;
  EquivalentMode out{.frequency_hz = law.frequency_hz * ratio,
                     .damping_ratio = 0.5 * loss / in_phase};
  if (loss > 0.) {
    out.viscous_share = viscous / loss;
    out.drag_share = drag / loss;
    out.friction_share = friction / loss;
  }
  return out;
}

}  // namespace vibrissa::separation
