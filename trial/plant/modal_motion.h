#pragma once

#include "trial/plant/joint.h"
#include "trial/plant/motion.h"
#include "trial/plant/state_space.h"
#include "trial/plant/structure.h"
#include "trial/plant/world.h"

namespace vibrissa::trial {

/// Modes and the hinge, at 16 times the sampling rate: exact steps of the modes, the hinge's moment
/// found by the secant rule in each. The hinge remembers from record to record. Proven by
/// tests/trial/generator/session_test.cc.
class ModalMotion : public Motion {
 public:
  /// Both must outlive it.
  ModalMotion(const Structure& structure, const World& world);

  std::size_t steps_per_sample() const override { return 16; }
  /// What depends on the motion that it drives (hinge, the air's relative speed) is found by
  /// repeating the step.
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
