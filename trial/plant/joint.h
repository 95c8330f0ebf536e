#pragma once

#include <array>

#include "trial/plant/world.h"

namespace vibrissa::trial {

/// Number of relaxation branches.
inline constexpr std::array<double, 5> branch_times_s{3e-4, 3e-3, 3e-2, 3e-1, 3.};

/// Moment of the hinge in addition to its linear spring [N m], with its memory. Proven by
/// tests/trial/plant/joint_test.cc.
class Joint {
 public:
  Joint(const JointWorld& world, double stiffness_n_m, double step_s);

  /// The moment at rotation phi and its rate; does not change the memory.
  double moment(double phi, double rate, double acceleration) const;
  /// Advances the memory by a time step that ends at this state.
  void advance(double phi);

 private:
  double spring_loss() const;
  double next_friction(double phi) const;

  JointWorld world_;
  double k_, step_s_;
  double phi_ = 0., peak_ = 0., age_s_ = 0.,
         friction_ = 0.;  // friction_: relative to the slip moment
  std::array<double, 5> branch_{};
};

}  // namespace vibrissa::trial
