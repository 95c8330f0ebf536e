#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "diagnosis/model/chain.h"
#include "diagnosis/model/higher_modes.h"

namespace vibrissa::diagnosis {

/// The first mode as a joint in series with an elastic whisker that has all the inertia:
///   joint    M = y + (rho / w) y' + T          (y = k phi elastic moment, T additional moment)
///   whisker  theta = p y + (1 - p) M           (rotations in units of the static compliance)
///   inertia  theta'' + 2 z w theta' = w^2 (M_ext - M)
/// An additional moment also moves the modes above the first (higher_modes.h), which add to y.
/// p: share of the joint in the compliance. The mode's damping ratio is zeta = z + p rho / 2; the
/// share of the joint in it follows from the viscous part of the base moment, base_rate / base_gain
/// = p rho. Proven by tests/diagnosis/model/joint_model_test.cc.
struct JointModel {
  double frequency_rad_s = 0.;
  double share = 1.;    // p
  double loss = 0.;     // rho
  double damping = 0.;  // z
  JointChange change{};
  std::vector<HigherMode> above{};
  double torque_share = 1.;  // of T that the first mode's series of joint and whisker carries

  /// viscous_ratio: NominalModel::joint_viscous_ratio times the joint loss factor.
  JointModel(const StructuralMode& mode, double joint_share, double viscous_ratio,
             const JointChange& change = {});

  /// Inertial moment divided by w^2 theta. The poles are where its product with the compliance of
  /// joint and whisker in series, share / stiffness_ratio + 1 - share, is -1.
  template <typename C>  // Complex or ComplexLanes
  C inertia(const C& s) const {
    const C x = s / frequency_rad_s;
    return x * x + 2. * damping * x;
  }
  /// The same model with changed factors.
  template <typename C>
  C changed_inertia(const C& s) const {
    const C x = s / frequency_rad_s;
    return change.inertia * (x * x + 2. * change.rest_damping * damping * x);
  }
  /// With the factors of spring and damper, relative to the nominal elastic moment.
  template <typename C>
  C changed_stiffness_ratio(const C& s) const {
    return change.spring + change.damper * (loss * s / frequency_rad_s);
  }
  /// Total moment of the joint's spring and damper divided by the elastic one, 1 + rho s / w.
  template <typename C>
  C stiffness_ratio(const C& s) const {
    return 1. + loss * s / frequency_rad_s;
  }

  /// The model that JointIntegrator integrates: with some flexibility of the whisker, some loss of
  /// the joint, and the modes above the first beside the whisker's flexibility, not in it.
  JointModel dynamic() const;
  /// Elastic moment y of the joint per T and per M_ext, with the factors.
  struct ElasticResponse {
    Complex torque, external;
  };
  ElasticResponse elastic_response(Complex s) const;
};

/// The joint model of a chain's first mode; nothing without a mode.
std::optional<JointModel> joint_of(const Chain& chain);

/// Exact time step of the joint model with its factors, for T and M_ext that are linear over the
/// step, starting from rest; one lane per record.
class JointIntegrator {
 public:
  /// model: JointModel::dynamic().
  JointIntegrator(const JointModel& model, double dt);

  /// Joint's elastic moment and its rate for given T and M_ext at the end of a step.
  Lanes elastic(const Lanes& torque, const Lanes& external) const {
    return free_.y + torque_new_(2) * torque + external_new_(2) * external + above_.elastic(torque);
  }
  Lanes elastic_rate(const Lanes& torque, const Lanes& external) const {
    return free_.rate + torque_rate_ * torque + external_rate_ * external + above_.rate(torque);
  }
  struct AtBase {
    Lanes moment, elastic;  // total, and the joint's elastic one
  };
  /// theta, its rate per second, the first mode's part of y, and the modes above.
  struct State {
    Lanes theta = Lanes::Zero(), theta_rate = Lanes::Zero(), y = Lanes::Zero();
    std::vector<HigherModesIntegrator::State> above{};
  };
  /// The state from which the next step goes, and the loads there.
  void start(const State& state, const Lanes& torque, const Lanes& external);
  /// theta at the end of the last step, and its rate per second.
  const Lanes& theta() const { return theta_; }
  Lanes theta_rate() const { return speed_ / dt_; }
  /// Makes the step; returns the moments at its end.
  AtBase accept(const Lanes& torque, const Lanes& external);

 private:
  double rate(const Eigen::Vector3d& state) const;
  void set_free(const Lanes& theta, const Lanes& speed, const Lanes& y, const Lanes& torque,
                const Lanes& external);

  double dt_, share_, rest_, rate_factor_, spring_;  // p, 1 / (1 - p), w / rho
  double beside_;                                    // of T, not carried by the first mode
  // State (theta, theta' per step, y).
  Eigen::Matrix3d transition_;
  Eigen::Vector3d torque_old_, torque_new_, external_old_, external_new_;
  double torque_rate_, external_rate_;
  struct Free {
    Lanes theta, speed, y, rate;
  } free_;  // next state without new loads
  HigherModesIntegrator above_;
  Lanes theta_ = Lanes::Zero(), speed_ = Lanes::Zero();
};

}  // namespace vibrissa::diagnosis
