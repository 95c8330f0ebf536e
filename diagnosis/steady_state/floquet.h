#pragma once

#include <algorithm>
#include <array>

#include "diagnosis/steady_state/harmonic_balance.h"

namespace vibrissa::diagnosis {

/// Floquet multipliers of the first mode about a periodic motion: eigenvalues of the map of small
/// changes of its deflection and velocity over one period (Nayfeh and Balachandran 1995, Applied
/// Nonlinear Dynamics, sec. 3.2.2). By integration in time (difference_integrator.h) with the laws'
/// memory, over the second of two periods, when changes of memory follow those of the motion.
/// Proven by tests/diagnosis/steady_state/duffing_test.cc.
struct FloquetMultipliers {
  std::array<Complex, 2> value{};
  /// Is the motion stable, that is, are all multipliers inside the unit circle?
  bool stable() const { return std::max(std::abs(value[0]), std::abs(value[1])) < 1.; }
};
FloquetMultipliers floquet_multipliers(const HarmonicBalance& balance,
                                       const PeriodicMotion& motion);

}  // namespace vibrissa::diagnosis
