#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "diagnosis/resonances/resonance_effects.h"

namespace vibrissa::diagnosis {

/// The change of the simulated first mode that the measured resonance requires.
struct ResonanceGap {
  double log_ratio = 0., deviation = 0.;  // of (f / f0)^2
  double joint_share = 1.;
  /// When both damping ratios are known: the simulated one, and the ratio measured / simulated.
  std::optional<double> simulated_damping{}, damping_change{};
  double damping_deviation = 0.;  // of ln damping_change

  double squared_ratio() const { return std::exp(log_ratio); }
  bool frequencies_agree() const;  // within two deviations
  bool dampings_agree() const;
  /// Ratio c / c0 that remains to be explained on a changed mode.
  std::optional<double> damping_left(const ModeChange& change) const;
  /// Prior density of its logarithm, usual 0.3 .. 3 (docs/effects.md); 1 without damping ratios.
  double damping_density(const ModeChange& change) const;
};

/// Effects that act together. The equation is solved for the last one, so a mount comes first.
using ResonanceEffects = std::vector<const ResonanceEffect*>;

/// A point on the line of values that give the measured resonance.
struct Solution {
  std::array<double, 2> values{};  // of the effects
  ModeChange change{};
  double density = 0.;  // along the line, per unit of ln (f / f0)^2
  double prior = 0.;    // of the point itself, including the remaining damper
};

double normal_density(double x, double deviation);

/// Density of the measured resonance under one or two effects: the integral of their priors over
/// the solution line and over the gap's standard deviation. Proven by
/// tests/diagnosis/resonances/resonance_gap_test.cc with sampled priors.
double evidence(const ResonanceEffects& effects, const ResonanceGap& gap);

/// The point of the line with the largest prior; nothing where the prior is zero.
std::optional<Solution> most_probable(const ResonanceEffects& effects, const ResonanceGap& gap);

}  // namespace vibrissa::diagnosis
