#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace vibrissa::separation {

/// Laws of a mode that decays freely. With the elastic moment y of its spring [N m] and
/// w = 2 pi frequency_hz,
///   y'' = -w^2 T,   T = y + cubic y^3 + slip z + 2 damping_ratio y' / w + drag |y'| y' / w^2,
/// where z is dry friction that sticks before it slips,
///   dz/dy = (stick_ratio / slip) (1 - z sgn y')           where it slips more and more,
///   dz/dy = (stick_ratio / slip) (1 + reversal |z|)       where the motion has turned,
/// Bouc's and Wen's with reversal 0 (Wen 1976, J. Eng. Mech. 102, 249-263), Dahl's with reversal 1
/// (1968, Aerospace TOR-0158(3107-18)). The record shows the base moment T. Proven by
/// tests/separation/ringdown/decay_law_test.cc.
struct DecayLaw {
  double frequency_hz = 0.;   // of the spring alone
  double damping_ratio = 0.;  // viscous
  double cubic = 0.;          // (N m)^-2
  double drag = 0.;           // (N m)^-1
  double slip = 0.;           // N m; 0: no friction
  double stick_ratio = 0.;    // stiffness of the friction while it sticks, over the spring's
  double reversal = 0.;       // 0 to 1
};

/// What a decay is released from.
struct DecayStart {
  double moment = 0., rate = 0.;  // y [N m] and y' / w [N m]
  double friction = 0.;           // z
  double offset = 0.;             // of the reading [N m]
  double drift = 0.;              // of the offset over all samples [N m]

  double amplitude() const { return std::hypot(moment, rate); }
};

/// The reading at n samples, by the classical Runge-Kutta rule of fourth order, friction exactly
/// between steps.
std::vector<double> decay(const DecayLaw& law, const DecayStart& start, std::size_t n,
                          double sampling_rate_hz);

/// The linear mode that swings like the law at one amplitude of the moment (harmonic linearisation,
/// Nayfeh and Mook 1979, section 4.2), and the shares of its damping.
struct EquivalentMode {
  double frequency_hz = 0., damping_ratio = 0.;
  double viscous_share = 0., drag_share = 0., friction_share = 0.;
};
EquivalentMode equivalent_mode(const DecayLaw& law, double amplitude);

}  // namespace vibrissa::separation
