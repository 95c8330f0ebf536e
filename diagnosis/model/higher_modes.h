#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/model/nominal_model.h"
#include "signals/base/lanes.h"

namespace vibrissa::diagnosis {

using signals::Lanes;

/// A mode above the first, moved by an additional moment T in the joint. With e the share of the
/// joint in the mode's elastic energy, its part of the joint's elastic moment follows
///   y'' + 2 d v y' + v^2 y = - e v^2 T
/// (modal superposition for a pair of moments, e.g. Geradin and Rixen 2015, Mechanical Vibrations,
/// ch. 2). The shares of all modes have the sum 1, so a static T does not reach the base.
struct HigherMode {
  double frequency_rad_s = 0., damping_ratio = 0., share = 0.;  // v, d, e

  Complex response(const Complex s) const {  // y per T
    const Complex x = s / frequency_rad_s;
    return -share / (x * x + 2. * damping_ratio * x + 1.);
  }
};

/// Exact time step of higher modes for a T that is linear over the step; one lane per record.
/// Proven by tests/diagnosis/model/joint_model_test.cc.
class HigherModesIntegrator {
 public:
  /// One mode's y and its rate per second.
  struct State {
    Lanes y = Lanes::Zero(), rate = Lanes::Zero();
  };

  HigherModesIntegrator(const std::vector<HigherMode>& modes, double dt);

  /// Sum over the modes at the end of a step, for T there.
  Lanes elastic(const Lanes& torque) const { return free_.y + per_torque_(0) * torque; }
  Lanes rate(const Lanes& torque) const { return free_.rate + per_torque_(1) * torque; }
  void start(const std::vector<State>& states, const Lanes& torque);
  /// Makes the step.
  void accept(const Lanes& torque);

 private:
  struct Mode {
    Eigen::Matrix2d transition;  // of (y, y')
    Eigen::Vector2d old_torque, new_torque;
    State next{};  // without the new T
  };
  void set_free(Mode& mode, const State& now, const Lanes& torque);

  std::vector<Mode> modes_;
  State free_{};
  Eigen::Vector2d per_torque_ = Eigen::Vector2d::Zero();
};

}  // namespace vibrissa::diagnosis
