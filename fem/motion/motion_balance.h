#pragma once

#include <Eigen/Dense>
#include <functional>
#include <vector>

#include "fem/linalg/linear_algebra.h"

namespace vibrissa::fem {

/// Balance of an approximate solution of A x = b, A symmetric positive definite, along some motions
/// r_d: x + sum_e c_e w_e with w_e = A^-1 M r_e leaves nothing of r_d^T (b - A x). The forces that
/// the rounding of a slender solid's factors leaves unbalanced have long lever arms and bend its
/// first modes; with the rigid motions and these for r this is the part of a refinement that base
/// moments ask for, at the price of inner products in place of a second solution. Proven by
/// tests/fem/motion/linear_transient_test.cc.
class MotionBalance {
 public:
  using Operator = std::function<void(const Vector& x, Vector& result)>;
  /// Motions are independent and zero at the clamp. Products with A and M and solutions with A, as
  /// exact as they can be, are used here alone.
  MotionBalance(std::vector<Vector> motions, const Operator& mass, const Operator& product,
                const Operator& solve);
  void restore(const Vector& right_hand_side, Vector& solution) const;

 private:
  std::vector<Vector> motions_, forces_, answers_;  // r, A r, w
  Eigen::PartialPivLU<Eigen::MatrixXd> unbalanced_by_;
};

}  // namespace vibrissa::fem
