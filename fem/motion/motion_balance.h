#pragma once

#include <Eigen/Dense>
#include <functional>
#include <vector>

#include "fem/linalg/linear_algebra.h"

namespace vibrissa::fem {

/// Corrects an approximate solution of A x = b, A symmetric positive definite, so that its residual
/// is zero along some motions r_d: x + sum_e c_e w_e with w_e = A^-1 M r_e gives r_d^T (b - A x) =
/// 0. Rounding errors in the factors of a slender solid leave unbalanced forces with long lever
/// arms, which excite the first modes. With rigid motions and first modes for r, this correction
/// gives accurate base moments; it needs only inner products instead of a second solution. Proven
/// by tests/fem/motion/linear_transient_test.cc.
class MotionBalance {
 public:
  using Operator = std::function<void(const Vector& x, Vector& result)>;
  /// The motions must be independent and zero at the clamp. The products with A and M and the
  /// solutions with A must be as exact as possible; they are used only here.
  MotionBalance(std::vector<Vector> motions, const Operator& mass, const Operator& product,
                const Operator& solve);
  void restore(const Vector& right_hand_side, Vector& solution) const;

 private:
  std::vector<Vector> motions_, forces_, answers_;  // r, A r, w
  Eigen::PartialPivLU<Eigen::MatrixXd> unbalanced_by_;
};

}  // namespace vibrissa::fem
