#pragma once

#include "trial/plant/joint.h"
#include "trial/plant/motion.h"
#include "trial/plant/state_space.h"
#include "trial/plant/structure.h"
#include "trial/plant/world.h"

namespace vibrissa::trial {

/// Modes and the nonlinear hinge at 16 times the sampling rate: exact time steps of the modes; the
/// hinge's moment is solved implicitly in each step. The hinge keeps its memory from record to
/// record. Proven by tests/trial/generator/session_test.cc.
class ModalMotion : public Motion {
 public:
  /// Both arguments must outlive this object.
  ModalMotion(const Structure& structure, const World& world);

  std::size_t steps_per_sample() const override { return 16; }
  /// Loads that depend on the motion (hinge, relative wind) are found by repeating the step.
  std::vector<double> base_moment(const std::vector<double>& acceleration,
                                  const std::vector<double>& wind, std::uint64_t seed) override;

 private:
  double hinge_moment(const Eigen::VectorXd& y, double acceleration, double guess) const;
  std::vector<double> stage_tilt(const std::vector<double>& acceleration) const;

  const World& world_;
  const Structure& structure_;
  StateSpace plant_;
  FirstOrderHold step_;
  Eigen::VectorXd hinge_effect_;
  Joint joint_;
};

}  // namespace vibrissa::trial
