#pragma once

#include <complex>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "signals/files/dataset.h"

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

/// How the structure follows one of its physical parameters x, from the finite-element model:
/// d ln(parameter) / d ln x, an entry to each mode of the NominalModel. Powers of x in between; a
/// static moment that x does not change has the exponent 0.
struct ParameterPath {
  std::vector<double> frequency, base_gain, wind_gain;
  double static_base_moment = 0., static_wind_moment = 0.;
};

/// Springs in series: how many times as stiff the one with this share of the compliance has to be
/// for the whole to be ratio times as stiff, 1 / ratio = share / result + 1 - share. A small share
/// cannot stiffen the whole at will: the result is at most 1000 share.
double spring_ratio(double ratio, double share);

/// The drag coefficient over the wind speed, of that at the speed which the wind gains are of:
/// linear between the speeds [m/s], which ascend, and constant beyond them. Empty: 1 at any speed.
struct DragCurve {
  std::vector<double> speed_m_s, factor;

  /// u |u| times the factor at u [m^2/s^2]. Proven by
  /// tests/diagnosis/nominal/nominal_from_model_test.cc.
  double drag(double speed) const;
};

/// What the simulation says: base acceleration and wind to base moment, linear in a and in u |u|
/// (times the drag curve, where there is one). The mode that base motion moves most comes first:
/// joint laws act on it, and it is the first mode everywhere here. The direct terms stand for the
/// modes above the band.
struct NominalModel {
  /// What its gains and rates are of: the base moment, or k_nominal times the joint's rotation.
  signals::Readout readout = signals::Readout::moment;
  std::vector<StructuralMode> modes;
  double base_direct = 0.;                  // N m / (m/s^2)
  double wind_direct = 0.;                  // N m / (m/s)^2
  bool has_base = false, has_wind = false;  // paths that the simulation determined
  /// Share of the joint (the silicone) in the compliance of the first mode, and how well it is
  /// known. Records do not tell it: 0.71 (docs/theory.md, T15) and 0.56 (our finite-element model)
  /// for flow sensors, 1 for a rigid whisker.
  double joint_share = 0.7, joint_share_deviation = 0.15;
  /// Factor on the joint's part of that mode's damping that the rates tell.
  double joint_loss_factor = 1.;
  DragCurve drag_curve{};
  /// By the names of the finite-element model's parameters (silicone_modulus, ...); empty when the
  /// simulation is records.
  std::map<std::string, ParameterPath> paths{};
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

  /// The path of that parameter; nullptr when it is not known or the first mode does not feel it.
  const ParameterPath* path(const std::string& parameter) const;
  /// The parameter's share in the first mode's compliance, d ln(stiffness) / d ln x.
  static double compliance_share(const ParameterPath& path) { return 2. * path.frequency.front(); }
  /// Name of the density that its mass follows: of the fin, or else of the wire; empty when neither
  /// is known.
  std::string mass_parameter() const;
  /// Takes every parameter along the path to ln x; the damping ratios stay. Proven by
  /// tests/diagnosis/nominal/nominal_from_model_test.cc.
  void follow(const ParameterPath& path, double log_x);

  /// Viscous over elastic moment of the joint times its share of the first mode's compliance, at
  /// that mode's frequency. A rotation does not show it: the joint is taken to hold all damping.
  double joint_viscous_ratio() const;

  /// Samples that so many time constants of the first mode last; 0 without a mode.
  std::size_t decay_samples(double n_time_constants, double sampling_rate_hz) const;
  /// Least half-power bandwidth of a mode, 2 zeta f [Hz]; infinite without a mode.
  double narrowest_mode_hz() const;
};

}  // namespace vibrissa::diagnosis
