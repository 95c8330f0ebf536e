#pragma once

#include <Eigen/Core>

namespace vibrissa::fem {
struct SensorParameters;
}

namespace vibrissa::trial {

/// Factors of the solid relative to the simulated one; 1 is as simulated.
struct SolidChange {
  double silicone_modulus = 1.;
  double fin_density = 1.;
  bool operator==(const SolidChange&) const = default;
};

/// The flow sensor in the plane of axial motion, from the finite-element model: every mode of that
/// plane among the lowest 44 (at least 12), mass-normalised, clamped base. SI units; tilt about the
/// base centre, positive from z towards x. Proven by tests/trial/plant/structure_test.cc.
struct Structure {
  Eigen::VectorXd frequency_rad_s, damping_ratio;
  Eigen::VectorXd base;  // participation of axial translation [√kg]
  Eigen::VectorXd tilt;  // participation of rotation about the base centre [√kg·m]
  Eigen::VectorXd wind;  // modal force of the drag per u|u|, at 2 m/s
  double mass_kg = 0.;
  double first_moment_kg_m = 0.;    // mass coupling of rotation and translation
  double inertia_kg_m2 = 0.;        // of rotation about the base centre
  double wind_force = 0.;           // N per u|u|
  double wind_moment = 0.;          // N m per u|u|
  double joint_share = 0.;          // share of the silicone in the first mode's compliance
  double joint_stiffness_n_m = 0.;  // of the hinge that represents the silicone

  /// Rotation of that hinge per modal coordinate. The hinge carries the base moment in the first
  /// mode; the other modes, in which the silicone itself vibrates, share the rest of its
  /// compliance.
  Eigen::VectorXd hinge() const;
};

/// The sensor as designed, with the given changes.
fem::SensorParameters sensor_parameters(const SolidChange& change);

/// Meshes, assembles and solves (about a second).
Structure solve_structure(const SolidChange& change);

}  // namespace vibrissa::trial
