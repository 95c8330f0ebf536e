#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "signals/dataset.h"

namespace vibrissa::diagnosis {

using Complex = std::complex<double>;

/// One mode of the structure in both of its paths:
///   share of M / a       = (base_gain + base_rate s/w) / ((s/w)^2 + 2 zeta s/w + 1),
///   share of M / (u |u|) likewise with wind_gain and wind_rate.
/// The rates are the viscous part of the base moment. With gains in N m the mode's coordinate is
/// its elastic share of the base moment.
struct StructuralMode {
  double frequency_rad_s = 0.;
  double damping_ratio = 0.;
  double base_gain = 0., base_rate = 0.;  // N m / (m/s^2)
  double wind_gain = 0., wind_rate = 0.;  // N m / (m/s)^2

  Complex base_response(Complex s) const;
  Complex wind_response(Complex s) const;
};

/// What the simulation says: base acceleration and wind to base moment, linear in a and in u |u|.
/// The mode that base motion moves most comes first: joint laws act on it, and it is the first mode
/// everywhere here. The direct terms stand for the modes above the band.
struct NominalModel {
  /// What its gains and rates are of: the base moment, or k_nominal times the joint's rotation.
  signals::Readout readout = signals::Readout::moment;
  std::vector<StructuralMode> modes;
  double base_direct = 0.;                  // N m / (m/s^2)
  double wind_direct = 0.;                  // N m / (m/s)^2
  bool has_base = false, has_wind = false;  // paths that the simulation determined
  /// Share of the joint (the silicone) in the compliance of the first mode, and how well it is
  /// known. Records do not tell it: 0.71 (paper.md) and 0.56 (our finite-element model) for
  /// flow sensors, 1 for a rigid whisker.
  double joint_share = 0.7, joint_share_deviation = 0.15;
  /// Factor on the joint's part of that mode's damping that the rates tell.
  double joint_loss_factor = 1.;
  /// rms of (simulated - model) over rms of simulated, on the simulation's own records: what this
  /// form cannot follow.
  double base_misfit = 0., wind_misfit = 0.;

  Complex base_response(Complex s) const { return responses(s).base; }
  Complex wind_response(Complex s) const { return responses(s).wind; }
  /// Both at once.
  struct Responses {
    Complex base, wind;
  };
  Responses responses(Complex s) const;

  /// Viscous over elastic moment of the joint times its share of the first mode's compliance, at
  /// that mode's frequency. A rotation does not show it: the joint is taken to hold all damping.
  double joint_viscous_ratio() const;

  /// Samples that so many time constants of the first mode last; 0 without a mode.
  std::size_t decay_samples(double n_time_constants, double sampling_rate_hz) const;
};

}  // namespace vibrissa::diagnosis
