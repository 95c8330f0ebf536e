#pragma once

#include <array>
#include <optional>
#include <vector>

#include "diagnosis/resonances/resonance_effects.h"

namespace vibrissa::diagnosis {

/// What measured parameters ask of the simulated first mode.
struct ResonanceGap {
  double log_ratio = 0., deviation = 0.;  // of (f / f0)^2
  double joint_share = 1.;
  /// When both damping ratios are known: the simulated one, and measured over simulated.
  std::optional<double> simulated_damping{}, damping_change{};
  double damping_deviation = 0.;  // of ln damping_change

  double squared_ratio() const;
  bool frequencies_agree() const;  // within two deviations
  bool dampings_agree() const;
  /// c / c0 that is left to explain on a changed mode.
  std::optional<double> damping_left(const ModeChange& change) const;
  /// Prior density of its logarithm, usual 0.3 .. 3 (docs/effects.md); 1 without damping ratios.
  double damping_density(const ModeChange& change) const;
};

/// Effects that act together; a mount comes before the one that is solved for, the last.
using ResonanceEffects = std::vector<const ResonanceEffect*>;

/// A point on the line of values that bring the resonance to the measured one.
struct Solution {
  std::array<double, 2> values{};  // of the effects
  ModeChange change{};
  double density = 0.;  // along the line, for one of ln (f / f0)^2
  double prior = 0.;    // of the point itself, with the damper that is left
};

double normal_density(double x, double deviation);

/// Density that one or two effects give the measured parameters: the integral of their priors over
/// the line of solutions and over the gap's deviation. Proven by
/// tests/diagnosis/resonances/resonance_gap_test.cc with sampled priors.
double evidence(const ResonanceEffects& effects, const ResonanceGap& gap);

/// The point of the line where the priors are largest; nothing where they all vanish.
std::optional<Solution> most_probable(const ResonanceEffects& effects, const ResonanceGap& gap);

}  // namespace vibrissa::diagnosis
