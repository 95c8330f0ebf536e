#include "fem/motion/motion_balance.h"

#include <utility>

namespace vibrissa::fem {

MotionBalance::MotionBalance(std::vector<Vector> motions, const Operator& mass,
                             const Operator& product, const Operator& solve)
    : motions_(std::move(motions)), forces_(motions_), answers_(motions_) {
  Vector momentum(motions_.front());
  for (std::size_t d = 0; d < motions_.size(); ++d) {
    product(motions_[d], forces_[d]);
    mass(motions_[d], momentum);
    solve(momentum, answers_[d]);
  }
  const auto n = static_cast<Eigen::Index>(motions_.size());
  Eigen::MatrixXd unbalanced_by(n, n);
  for (Eigen::Index d = 0; d < n; ++d)
    for (Eigen::Index e = 0; e < n; ++e)
      unbalanced_by(d, e) =
          forces_[static_cast<std::size_t>(d)] * answers_[static_cast<std::size_t>(e)];
  unbalanced_by_.compute(unbalanced_by);
}

void MotionBalance::restore(const Vector& right_hand_side, Vector& solution) const {
  Eigen::VectorXd left(static_cast<Eigen::Index>(motions_.size()));
  for (std::size_t d = 0; d < motions_.size(); ++d)
    left[static_cast<Eigen::Index>(d)] = motions_[d] * right_hand_side - forces_[d] * solution;
  const Eigen::VectorXd share = unbalanced_by_.solve(left);
  for (std::size_t e = 0; e < motions_.size(); ++e)
    solution.add(share[static_cast<Eigen::Index>(e)], answers_[e]);
}

}  // namespace vibrissa::fem
