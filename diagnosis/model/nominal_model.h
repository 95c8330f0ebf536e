#pragma once

#include <complex>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

using Complex = std::complex<double>;

/// One mode of the structure in the base path and in the wind path:
///   share of M / a       = (base_gain + base_rate s/w) / ((s/w)^2 + 2 zeta s/w + 1),
///   share of M / (u |u|) likewise with wind_gain and wind_rate.
/// The rates are the viscous part of the base moment. The mode's coordinate is its elastic part of
/// the base moment [N m].
struct StructuralMode {
  double frequency_rad_s = 0.;
  double damping_ratio = 0.;
  double base_gain = 0., base_rate = 0.;  // N m / (m/s^2)
  double wind_gain = 0., wind_rate = 0.;  // N m / (m/s)^2

  Complex base_response(Complex s) const;
  Complex wind_response(Complex s) const;
  /// Multiplies the damping ratio, and with it the viscous part of both moments.
  void scale_damping(double factor) {
    damping_ratio *= factor;
    base_rate *= factor;
    wind_rate *= factor;
  }
};

/// Sensitivity of the structure to one physical parameter x, from the finite-element model: d
/// ln(quantity) / d ln x, one entry per mode of the NominalModel. Quantities change as powers of x;
/// a static moment that does not depend on x has the exponent 0.
struct ParameterPath {
  std::vector<double> frequency, base_gain, wind_gain;
  double static_base_moment = 0., static_wind_moment = 0.;
};

/// Springs in series: stiffness factor of the spring with this share of the compliance that makes
/// the whole ratio times as stiff, 1 / ratio = share / result + 1 - share. The result is at most
/// 1000 share, because a spring with a small share cannot stiffen the whole arbitrarily.
double spring_ratio(double ratio, double share);

/// Drag coefficient as a function of wind speed, relative to that at the speed of the wind gains:
/// linear between the ascending speeds [m/s] and constant beyond them. Empty: 1 at any speed.
struct DragCurve {
  std::vector<double> speed_m_s, factor;

  /// u |u| times the drag factor at u [m^2/s^2]. Proven by
  /// tests/diagnosis/nominal/nominal_from_model_test.cc.
  double drag(double speed) const;
};

/// The simulation as a model from base acceleration and wind to base moment, linear in a and in u
/// |u| (times the drag curve, if any). The mode that responds most to base motion comes first;
/// joint laws act on it, and "first mode" means this mode. The direct terms represent the modes
/// above the band.
struct NominalModel {
  /// Quantity of the gains and rates: the base moment, or k_nominal times the joint's rotation.
  signals::Readout readout = signals::Readout::moment;
  bool readout_is_given = true;  // otherwise the readout is a guess
  std::vector<StructuralMode> modes;
  double base_direct = 0.;                  // N m / (m/s^2)
  double wind_direct = 0.;                  // N m / (m/s)^2
  bool has_base = false, has_wind = false;  // paths that the simulation determines
  /// Share of the joint (the silicone) in the compliance of the first mode, and its standard
  /// deviation. Records do not determine it. Values: 0.71 (docs/theory.md, T15) and 0.56
  /// (finite-element model of this program) for flow sensors, 1 for a rigid whisker.
  double joint_share = 0.7, joint_share_deviation = 0.15;
  /// Part of the rest, 1 - joint_share, that the joint has in the elastic energy of the modes above
  /// the first, and its standard deviation. Records of the simulation do not determine it.
  double higher_joint_share = 0.5, higher_joint_share_deviation = 0.3;
  /// Factor on the joint's part of that mode's damping as it follows from the rates.
  double joint_loss_factor = 1.;
  DragCurve drag_curve{};
  /// Sensitivities by parameter of the finite-element model (silicone_modulus, ...); empty when the
  /// simulation is given as records.
  std::map<std::string, ParameterPath> paths{};
  /// Misfit of this model form: rms of (simulated - model) divided by the rms of simulated, on the
  /// simulation's own records.
  double base_misfit = 0., wind_misfit = 0.;

  Complex base_response(Complex s) const { return responses(s).base; }
  Complex wind_response(Complex s) const { return responses(s).wind; }
  template <typename C>
  struct Responses {
    C base, wind;
  };
  /// Both paths at s, a Complex or ComplexLanes.
  template <typename C>
  Responses<C> responses(const C& s) const {
    Responses<C> sum{.base = base_direct, .wind = wind_direct};
    for (const StructuralMode& mode : modes) {
      const C x = s / mode.frequency_rad_s,
              compliance = 1. / (x * x + 2. * mode.damping_ratio * x + 1.);
      sum.base += (mode.base_gain + mode.base_rate * x) * compliance;
      sum.wind += (mode.wind_gain + mode.wind_rate * x) * compliance;
    }
    return sum;
  }

  /// The sensitivities to a parameter; nullptr when they are unknown or the first mode does not
  /// depend on it.
  const ParameterPath* path(const std::string& parameter) const;
  /// The parameter's share in the first mode's compliance, d ln(stiffness) / d ln x.
  static double compliance_share(const ParameterPath& path) { return 2. * path.frequency.front(); }
  /// Name of the density that represents the mass: of the fin, otherwise of the wire; empty when
  /// neither is known.
  std::string mass_parameter() const;
  /// Changes all quantities along the path to ln x; the damping ratios stay unchanged. Proven by
  /// tests/diagnosis/nominal/nominal_from_model_test.cc.
  void follow(const ParameterPath& path, double log_x);

  /// Ratio of viscous to elastic moment of the joint times its share of the first mode's
  /// compliance, at that mode's frequency. A rotation readout does not show it; then the joint is
  /// assumed to have all the damping.
  double joint_viscous_ratio() const;

  /// How that part is distributed over the modes above the first, sum 1: as the joint's energy in
  /// them by the finite-element model, or else in proportion to base gain times squared frequency,
  /// which holds where their effective heights are equal.
  std::vector<double> higher_joint_weights() const;

  /// Duration of this many time constants of the first mode, in samples; 0 without a mode.
  std::size_t decay_samples(double n_time_constants, double sampling_rate_hz) const;
};

}  // namespace vibrissa::diagnosis
