#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis {

/// Changes of the first mode by effects, as factors on the simulated mode.
struct ModeChange {
  double joint = 1.;              // spring of the joint (the silicone)
  double inertia = 1.;            // modal mass
  double series_compliance = 0.;  // of a spring below the joint, relative to the mode's compliance
  /// Frequency of a mount between accelerometer and base, without the sensor, over that of the
  /// simulated first mode.
  std::optional<double> mount_frequency{};
  double mount_mass = 0.;  // apparent mass ratio of the first mode at the mount
};

/// (f / f0)^2 of the lower resonance, k0 and f0 being the simulated mode's and p the joint's share
/// in its compliance:
///   k / k0 = 1 / (p / joint + 1 - p + series),  n = (k / k0) / inertia;
/// on a mount of frequency b f0 the lower root of x^2 - (b^2 + (1 + m) n) x + b^2 n = 0 in place of
/// n (catalogue, mount_compliance). The springs in series agree with the finite-element model:
/// tests/diagnosis/resonances/resonance_gap_test.cc.
double squared_frequency_ratio(const ModeChange& change, double joint_share);

/// zeta / zeta0 of that resonance with the modal damper unchanged: sqrt(t / inertia) t / r^2, r =
/// k / k0 without the series spring and t with it, as a lossless series spring shares in the motion
/// but not in the loss. On a mount the losses are weighted by strain energy; the mount's own ratio
/// is mount_damping_ratio.
double damping_ratio_factor(const ModeChange& change, double joint_share,
                            double nominal_damping_ratio);

constexpr double mount_damping_ratio = 0.022;  // between 0.01 and 0.05 (docs/effects.md)

/// A prior that is mostly within a usual range and seldom in a wider one.
struct UsualPrior {
  Prior usual{};
  std::optional<Prior> beyond{};  // has a tenth of the probability

  double density(double x) const;
  double lowest() const { return beyond ? std::min(usual.low, beyond->low) : usual.low; }
  double highest() const { return beyond ? std::max(usual.high, beyond->high) : usual.high; }
};

/// An effect as a change of a resonance: one parameter that acts on one part of the mode.
struct ResonanceEffect {
  enum class Part { joint, inertia, series, mount };

  const Effect* effect = nullptr;  // of the catalogue
  Part part = Part::joint;
  struct Map {
    std::function<double(double)> to_factor{}, to_value{};
  } map{};                                 // from the value to the factor on the part, and back
  Parameter parameter{};                   // its name, unit and fitted coordinate
  UsualPrior prior{};                      // of the coordinate
  double usual_low = 0., usual_high = 0.;  // of the value (docs/effects.md)
  std::optional<Parameter> mass_ratio{};   // of a mount
  std::string remark{};                    // meaning of the value

  void apply(double value, ModeChange& change) const;
  /// The value that gives the changed mode a squared frequency ratio; nothing when no value does.
  std::optional<double> solve(const ModeChange& others, double squared_ratio,
                              double joint_share) const;
};

/// The effects of the catalogue that can shift a first resonance by more than its uncertainty.
/// Priors:
///  * stiffness: the silicone's modulus. Two ways to know it differ: Gent's relation for Shore 20A
///    gives 0.73 MPa, the reference study's Yeoh fit 6 c1 = 2.04 MPa (docs/theory.md, T15). A
///    simulation with a modulus between them is usually wrong by 0.73 MPa to 2.04 MPa over its own;
///    for any other, also an unknown one, the same factor of 2.8 either way.
///  * mass: 0.9 to 1.1 usual (infill of a printed fin, glue, magnet), heavy tails.
///  * temperature_drift: 0.5 %/K over 20 K are a scale of 10 %; usual up to 30 % (docs/effects.md).
///  * base_compliance, mount_compliance, softening_history, hardening, joint_friction,
///    viscoelastic: uniform (in the logarithm, as the catalogue) over the usual range of
///    docs/effects.md, a tenth over the catalogue's own bounds.
/// simulated_hz makes mount frequencies relative. Left out are effects that do not shift poles
/// (links wind, sensor, reference; damping: f sqrt(1 - 2 zeta^2) moves by 0.4 % at zeta 0.05),
/// extra_mode, clock_drift (at most 0.1 %) and backlash, whose gap has no scale without amplitude.
std::vector<ResonanceEffect> resonance_effects(double simulated_hz,
                                               std::optional<double> silicone_modulus_pa);

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

/// Density of the measured resonance under one or two effects: the integral of their priors over
/// the solution line and over the gap's standard deviation. Proven by
/// tests/diagnosis/resonances/resonance_gap_test.cc with sampled priors.
double evidence(const ResonanceEffects& effects, const ResonanceGap& gap);

/// The point of the line with the largest prior; nothing where the prior is zero.
std::optional<Solution> most_probable(const ResonanceEffects& effects, const ResonanceGap& gap);

}  // namespace vibrissa::diagnosis
