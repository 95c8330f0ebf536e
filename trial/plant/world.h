#pragma once

#include <limits>

#include "trial/plant/structure.h"

namespace vibrissa::trial {

/// Range of the accelerometer noise of different benches [m/s^2]. The diagnosis does not know the
/// value of a bench.
inline constexpr double quietest_accelerometer = 0.03, loudest_accelerometer = 0.06;
/// Range of the moment noise [N m]: from slightly below that of the reference study's Hall element
/// (5.43 uT at 0.18 N m/T) to twenty times that noise.
inline constexpr double quietest_moment = 0.7e-6, loudest_in_quietest = 28.;
/// Peak rotation of the hinge at the higher level [rad].
inline constexpr double usual_turn = 9.4e-3;
/// Standard deviations of built sensors from their design (building tolerances).
inline constexpr double built_modulus = 0.02, built_damping = 0.08, built_gain = 0.015,
                        built_drag = 0.05;

/// Properties of the silicone hinge in addition to its linear spring. phi: rotation of the hinge.
struct JointWorld {
  double stiffening = 0.;       // k phi_s (sinh(phi/phi_s) - phi/phi_s), phi_s = scale/sqrt(6 this)
  double branches = 0.;         // total strength of five relaxation branches, 0.3 ms .. 3 s
  double softening = 0.;        // share of k lost at large rotations, recovered within 20 s
  double warming = 0.;          // share of k lost during the session, within half a minute
  double friction_moment = 0.;  // Bouc-Wen, N m
  double friction_stiffness = 0.;  // relative to k
  double dead_zone = 0.;           // rad, no restoring moment within ± this
  double stop =
      std::numeric_limits<double>::infinity();  // rad, rotation at which a stop is touched
  double parametric = 0.;         // s^2/m, relative change of k per axial acceleration
  double quadratic_damping = 0.;  // s^2/rad, damping moment / k per rate squared
  double scale = 1.;              // rad, usual peak rotation
  bool is_linear() const;
};

/// A sensor on its bench with all possible deviations from the simulation. The default has none.
struct World {
  SolidChange solid{};
  double damping = 1.;
  JointWorld joint{};
  double base_compliance = 0.;               // k0 / k_s of a massless spring under the base
  double mount_hz = 0.;                      // frequency of a base of 0.1 kg on its mount; 0: rigid
  double extra_hz = 0., extra_residue = 0.;  // of an additional oscillator beside the sensor
  double rocking = 0.;  // rad/m, rocking of the stage, which has its resonance at 180 Hz

  double drag = 1.;
  double own_motion = 0.;  // share of the whisker's velocity in the relative wind
  double flow_lag_s = 0.;
  double shedding = 0.;  // force coefficient of the wake, Strouhal number 0.17
  double unseen = 0.;    // intensity of turbulence that the probe does not measure

  double reference_gain = 1., reference_highpass_hz = 0., cross_axis = 0.;
  double reference_noise = 0.;  // m/s^2 per sample, in addition to the usual noise

  double sensor_gain = 1.;
  double field_curvature = 0.;  // 1/(N m), nonlinearity of the magnet's field over its distance
  double feedthrough = 0.;      // N m per m/s^2
  double ramp = 0., walk = 0.;  // N m/s, N m/sqrt(s)
  double hum = 0., hum_hz = 50.03;

  double delay_s = 0., conversion_s = 0., rate_error = 0.;
  double read_rate_hz =
      0.;  // rate of the accelerometer's own conversions; 0: sampled at each reading

  double loose_gain = 0.;   // gain lost at an intermittent contact
  double wind_pickup = 0.;  // N m per m/s
  double step_size = 0.;    // N m, step of a coarse converter
  double slew = 0.;         // N m/s, slew rate of the amplifier; 0: unlimited
  double cable_peak = 0.;   // height of a resonance of the accelerometer's glue at 70 Hz

  double moment_noise = 0., acceleration_noise = 0., noise_colour = 0.;
};

}  // namespace vibrissa::trial
