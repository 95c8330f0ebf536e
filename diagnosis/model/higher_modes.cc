#include "diagnosis/model/higher_modes.h"

#include <Eigen/Dense>
#include <cassert>
#include <unsupported/Eigen/MatrixFunctions>

namespace vibrissa::diagnosis {

HigherModesIntegrator::HigherModesIntegrator(const std::vector<HigherMode>& modes,
                                             const double dt) {
  for (const HigherMode& mode : modes) {
    const double v = mode.frequency_rad_s;
    // States y, y', then T and its slope over the step.
    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
    a(0, 1) = dt;
    a(1, 0) = -v * v * dt;
    a(1, 1) = -2. * mode.damping_ratio * v * dt;
    a(1, 2) = -mode.share * v * v * dt;
    a(2, 3) = 1.;
    const Eigen::Matrix4d e = a.exp();
    const Eigen::Vector2d at_end = e.block<2, 1>(0, 3);
    modes_.push_back({.transition = e.topLeftCorner<2, 2>(),
                      .old_torque = e.block<2, 1>(0, 2) - at_end,
                      .new_torque = at_end});
    per_torque_ += at_end;
  }
}

void HigherModesIntegrator::set_free(Mode& mode, const State& now, const Lanes& torque) {
  const auto next = [&](const Eigen::Index i) -> Lanes {
    return mode.transition(i, 0) * now.y + mode.transition(i, 1) * now.rate +
           mode.old_torque(i) * torque;
  };
  mode.next = {next(0), next(1)};
  free_.y += mode.next.y;
  free_.rate += mode.next.rate;
}

void HigherModesIntegrator::start(const std::vector<State>& states, const Lanes& torque) {
  assert(states.size() == modes_.size());
  free_ = {};
  for (std::size_t k = 0; k < modes_.size(); ++k) set_free(modes_[k], states[k], torque);
}

void HigherModesIntegrator::accept(const Lanes& torque) {
  free_ = {};
  for (Mode& mode : modes_)
    set_free(
        mode,
        {mode.next.y + mode.new_torque(0) * torque, mode.next.rate + mode.new_torque(1) * torque},
        torque);
}

}  // namespace vibrissa::diagnosis
