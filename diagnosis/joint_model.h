#pragma once

#include <Eigen/Core>

#include "diagnosis/nominal_model.h"

namespace vibrissa::diagnosis {

/// The first mode as a joint in series with an elastic whisker that carries all inertia:
///   joint    M = y + (rho / w) y' + T          (y = k phi its elastic moment, T what is added to
///   it) whisker  theta = p y + (1 - p) M           (rotations in units of the static compliance)
///   inertia  theta'' + 2 z w theta' = w^2 (M_ext - M)
/// p: share of the joint in the compliance. The mode's damping ratio is zeta = z + p rho / 2; the
/// share of the joint in it follows from the viscous part of the base moment, base_rate / base_gain
/// = p rho. Proven by tests/diagnosis/joint_model_test.cc.
struct JointModel {
  double frequency_rad_s = 0.;
  double share = 1.;    // p
  double loss = 0.;     // rho
  double damping = 0.;  // z

  JointModel(const StructuralMode& mode, double joint_share, double loss_factor = 1.);

  /// 1 - P: moment at the base for a moment T added in the joint, (1 - P) T.
  Complex added_moment(Complex s) const;
  /// Moment of inertia over moment of the springs per rotation: the poles are where it is -1.
  /// change: D of a joint K(s) (1 + D).
  Complex inertia_ratio(Complex s, Complex change = 0.) const;
  /// Viscous and elastic moment of the joint over its elastic one, 1 + rho s / w.
  Complex stiffness_ratio(Complex s) const { return 1. + loss * s / frequency_rad_s; }
};

/// Exact step of the joint model for T and M_ext that run linearly over it, from rest.
class JointIntegrator {
 public:
  JointIntegrator(const JointModel& model, double dt);

  /// State (theta, theta' dt, y) after a step at whose end T and M_ext are as given.
  Eigen::Vector3d moved(double torque, double external) const {
    return free_ + torque_new_ * torque + external_new_ * external;
  }
  void accept(const Eigen::Vector3d& state, double torque, double external);
  double moment(const Eigen::Vector3d& state) const;
  double elastic_rate(const Eigen::Vector3d& state, double torque) const;

 private:
  JointModel model_;
  double dt_;
  Eigen::Matrix3d transition_;
  Eigen::Vector3d torque_old_, torque_new_, external_old_, external_new_;
  Eigen::Vector3d free_ = Eigen::Vector3d::Zero();  // next state without new loads
};

}  // namespace vibrissa::diagnosis
