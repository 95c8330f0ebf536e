#include "diagnosis/model/joint_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <unsupported/Eigen/MatrixFunctions>

namespace vibrissa::diagnosis {
namespace {

/// The integrator has the joint's elastic moment as a state, so the whisker needs some flexibility
/// and the joint some loss.
constexpr double most_share = 0.9999, least_loss = 1e-3;

}  // namespace

JointModel::JointModel(const StructuralMode& mode, const double joint_share,
                       const double viscous_ratio, const JointChange& joint_change)
    : frequency_rad_s(mode.frequency_rad_s), share(joint_share), change(joint_change) {
  const double in_joint = std::clamp(viscous_ratio, 0., 2. * mode.damping_ratio);
  loss = in_joint / share;
  damping = mode.damping_ratio - 0.5 * in_joint;
}

JointModel JointModel::dynamic() const {
  assert(torque_share == 1. && "already dynamic");
  JointModel model = *this;
  for (const HigherMode& mode : above) model.torque_share -= mode.share;
  model.share = std::min(share / model.torque_share, most_share);
  model.loss = std::max(loss * model.torque_share, least_loss);
  return model;
}

JointModel::ElasticResponse JointModel::elastic_response(const Complex s) const {
  const Complex resisting = changed_inertia(s), whole = 1. + (1. - share) * resisting,
                per_load = 1. / (share * resisting + whole * changed_stiffness_ratio(s));
  Complex torque = -torque_share * whole * per_load;
  for (const HigherMode& mode : above) torque += mode.response(s);
  return {.torque = torque, .external = per_load};
}

std::optional<JointModel> joint_of(const Chain& chain) {
  if (chain.structure.modes.empty()) return std::nullopt;
  JointModel model(chain.structure.modes.front(), chain.joint_share,
                   chain.joint_loss_factor * chain.structure.joint_viscous_ratio(),
                   chain.joint_change);
  const std::vector<double> weights = chain.structure.higher_joint_weights();
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const StructuralMode& mode = chain.structure.modes[k + 1];
    model.above.push_back(
        {.frequency_rad_s = mode.frequency_rad_s,
         .damping_ratio = mode.damping_ratio,
         .share = chain.higher_joint_share * (1. - chain.joint_share) * weights[k]});
  }
  return model;
}

JointIntegrator::JointIntegrator(const JointModel& model, const double dt)
    : dt_(dt), above_(model.above, dt) {
  beside_ = 1. - model.torque_share;
  share_ = model.share;
  rest_ = 1. / (1. - model.share);
  spring_ = model.change.spring;
  rate_factor_ = model.frequency_rad_s / (model.change.damper * model.loss);
  // M = (theta - p y) / (1 - p), with time in steps.
  const double angle = model.frequency_rad_s * dt, relax = rate_factor_ * dt;
  const double pull = angle * angle / model.change.inertia;
  // States theta, theta', y, then T, M_ext and their slopes over the step.
  Eigen::Matrix<double, 7, 7> a = Eigen::Matrix<double, 7, 7>::Zero();
  a(0, 1) = 1.;
  a(1, 0) = -pull * rest_;
  a(1, 1) = -2. * model.change.rest_damping * model.damping * angle;
  a(1, 2) = pull * rest_ * model.share;
  a(1, 4) = pull;
  a(2, 0) = relax * rest_;
  a(2, 2) = -relax * (rest_ * model.share + spring_);
  a(2, 3) = -relax * model.torque_share;
  a(3, 5) = 1.;
  a(4, 6) = 1.;
  const Eigen::Matrix<double, 7, 7> e = a.exp();
  transition_ = e.topLeftCorner<3, 3>();
  torque_new_ = e.block<3, 1>(0, 5);
  torque_old_ = e.block<3, 1>(0, 3) - torque_new_;
  external_new_ = e.block<3, 1>(0, 6);
  external_old_ = e.block<3, 1>(0, 4) - external_new_;
  torque_rate_ = rate(torque_new_) - rate_factor_ * model.torque_share;
  external_rate_ = rate(external_new_);
  free_ = {Lanes::Zero(), Lanes::Zero(), Lanes::Zero(), Lanes::Zero()};
}

double JointIntegrator::rate(const Eigen::Vector3d& state) const {
  return rate_factor_ * ((state(0) - share_ * state(2)) * rest_ - spring_ * state(2));
}

void JointIntegrator::set_free(const Lanes& theta, const Lanes& speed, const Lanes& y,
                               const Lanes& torque, const Lanes& external) {
  theta_ = theta;
  speed_ = speed;
  const auto next = [&](Eigen::Index i) -> Lanes {
    return transition_(i, 0) * theta + transition_(i, 1) * speed + transition_(i, 2) * y +
           torque_old_(i) * torque + external_old_(i) * external;
  };
  free_.theta = next(0);
  free_.speed = next(1);
  free_.y = next(2);
  free_.rate = rate_factor_ * ((free_.theta - share_ * free_.y) * rest_ - spring_ * free_.y);
}

void JointIntegrator::start(const State& state, const Lanes& torque, const Lanes& external) {
  set_free(state.theta, state.theta_rate * dt_, state.y, torque, external);
  above_.start(state.above, torque);
}

JointIntegrator::AtBase JointIntegrator::accept(const Lanes& torque, const Lanes& external) {
  const auto loaded = [&](const Lanes& free, Eigen::Index i) -> Lanes {
    return free + torque_new_(i) * torque + external_new_(i) * external;
  };
  const Lanes theta = loaded(free_.theta, 0), speed = loaded(free_.speed, 1),
              y = loaded(free_.y, 2);
  set_free(theta, speed, y, torque, external);
  const Lanes higher = above_.elastic(torque), higher_rate = above_.rate(torque);
  above_.accept(torque);
  return {(theta - share_ * y) * rest_ + beside_ * torque + spring_ * higher +
              higher_rate / rate_factor_,
          y + higher};
}

}  // namespace vibrissa::diagnosis
