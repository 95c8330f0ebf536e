#pragma once

#include <boost/numeric/odeint.hpp>
#include <functional>

#include "separation/model/rational_model.h"
#include "separation/segments/aligned_segment.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation::test {

/// Force of a joint law per modal mass.
using Force = std::function<double(double x, double v)>;

/// Amplitude of each line of the base acceleration at a time.
using Level = std::function<double(double t)>;

/// A shaken oscillator x'' + a1 x' + a0 x + force(x, x') = u, integrated by the Runge-Kutta method
/// of orders 7 and 8 of Fehlberg (Boost.Odeint), the base moved by lines that sum to u at any time.
/// The record begins after the start has decayed.
struct Shaken {
  Signal acceleration, moment;

  Shaken(const ModalTerm& mode, const Force& force, bool moment_readout, std::size_t n,
         const Level& level, std::uint64_t seed) {
    namespace odeint = boost::numeric::odeint;
    using State = std::array<double, 2>;
    const Lines lines(3., 100., 30, seed);
    const auto u = [&](double t) { return level(t) * lines.sample(1, 1., -t)[0]; };
    const auto rate = [&](const State& s, State& r, double t) {
      r = {s[1], u(t) - mode.a1 * s[1] - mode.a0 * s[0] - force(s[0], s[1])};
    };
    const auto stepper =
        odeint::make_controlled(1e-15, 1e-10, odeint::runge_kutta_fehlberg78<State>());
    constexpr std::size_t settling = 500;
    State state{};
    for (std::size_t i = 0; i < settling + n; ++i) {
      const double t = static_cast<double>(i) / rate_hz;
      if (i >= settling) {
        acceleration.push_back(u(t));
        moment.push_back(mode.b0 * state[0] + mode.b1 * state[1] +
                         (moment_readout ? mode.b0 / mode.a0 * force(state[0], state[1]) : 0.));
      }
      odeint::integrate_adaptive(stepper, rate, state, t, t + 1. / rate_hz, 0.5 / rate_hz);
    }
  }

  Shaken(const ModalTerm& mode, const Force& force, bool moment_readout, std::size_t n,
         double level, std::uint64_t seed)
      : Shaken(
            mode, force, moment_readout, n, [=](double) { return level; }, seed) {}

  void add_noise(double share, std::uint64_t seed) {
    moment = plus_noise(moment, share * rms(moment), seed);
  }
  Segment segment() const { return {acceleration, moment}; }
};

/// The flow sensor's first mode.
inline ModalTerm shaken_mode() {
  return make_modal_term(31.47, 0.027, -9e-6);
}

}  // namespace vibrissa::separation::test
