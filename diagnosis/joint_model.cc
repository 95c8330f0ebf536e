#include "diagnosis/joint_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <unsupported/Eigen/MatrixFunctions>

namespace vibrissa::diagnosis {
namespace {

/// The integrator keeps the joint's elastic moment as a state of its own: it needs a little
/// flexibility of the whisker and a little loss in the joint.
constexpr double most_share = 0.9999, least_loss = 1e-3;

JointModel made_dynamic(JointModel model) {
  model.share = std::min(model.share, most_share);
  model.loss = std::max(model.loss, least_loss);
  return model;
}

}  // namespace

JointModel::JointModel(const StructuralMode& mode, const double joint_share,
                       const double loss_factor)
    : frequency_rad_s(mode.frequency_rad_s), share(joint_share) {
  const double viscous = mode.base_gain != 0. ? mode.base_rate / mode.base_gain : 0.;
  const double in_joint = std::clamp(loss_factor * viscous, 0., 2. * mode.damping_ratio);
  loss = in_joint / share;
  damping = mode.damping_ratio - 0.5 * in_joint;
}

Complex JointModel::inertia_ratio(const Complex s, const Complex change) const {
  const Complex x = s / frequency_rad_s;
  return (x * x + 2. * damping * x) * (share / (stiffness_ratio(s) * (1. + change)) + 1. - share);
}

Complex JointModel::added_moment(const Complex s) const {
  const Complex x = s / frequency_rad_s;
  const Complex inertia = x * x + 2. * damping * x;
  return share * inertia / (stiffness_ratio(s) * (1. + inertia_ratio(s)));
}

JointIntegrator::JointIntegrator(const JointModel& model, const double dt)
    : model_(made_dynamic(model)), dt_(dt) {
  // M = (theta - p y) / (1 - p), with time in steps.
  const double angle = model_.frequency_rad_s * dt, rest = 1. / (1. - model_.share);
  const double relax = angle / model_.loss;
  // States theta, theta', y, then T, M_ext and their slopes over the step.
  Eigen::Matrix<double, 7, 7> a = Eigen::Matrix<double, 7, 7>::Zero();
  a(0, 1) = 1.;
  a(1, 0) = -angle * angle * rest;
  a(1, 1) = -2. * model_.damping * angle;
  a(1, 2) = angle * angle * rest * model_.share;
  a(1, 4) = angle * angle;
  a(2, 0) = relax * rest;
  a(2, 2) = -relax * (rest * model_.share + 1.);
  a(2, 3) = -relax;
  a(3, 5) = 1.;
  a(4, 6) = 1.;
  const Eigen::Matrix<double, 7, 7> e = a.exp();
  transition_ = e.topLeftCorner<3, 3>();
  torque_new_ = e.block<3, 1>(0, 5);
  torque_old_ = e.block<3, 1>(0, 3) - torque_new_;
  external_new_ = e.block<3, 1>(0, 6);
  external_old_ = e.block<3, 1>(0, 4) - external_new_;
}

void JointIntegrator::accept(const Eigen::Vector3d& state, const double torque,
                             const double external) {
  free_ = transition_ * state + torque_old_ * torque + external_old_ * external;
}

double JointIntegrator::moment(const Eigen::Vector3d& state) const {
  return (state(0) - model_.share * state(2)) / (1. - model_.share);
}

double JointIntegrator::elastic_rate(const Eigen::Vector3d& state, const double torque) const {
  return model_.frequency_rad_s / model_.loss * (moment(state) - state(2) - torque);
}

}  // namespace vibrissa::diagnosis
