#pragma once

#include <functional>
#include <memory>

#include "fem/factors/sparse_factors.h"

namespace vibrissa::fem {

/// Sparse Cholesky factors of a symmetric positive definite matrix for any number of solutions. A
/// solution for one vector includes one step of iterative refinement. Throws IndefiniteMatrix when
/// the matrix is not positive definite, signals::UserError or std::bad_alloc when memory runs out.
/// The matrix must outlive the factors. Proven by tests/fem/factors/cholesky_solver_test.cc.
class CholeskySolver {
 public:
  /// Product with the matrix for the refinement, when the assembled matrix is not exact enough;
  /// nothing: the matrix itself.
  using Product = std::function<void(const Vector& x, Vector& product)>;
  explicit CholeskySolver(const Matrix& matrix, Product product = {});
  /// Factorises again after the values of the matrix changed, but not its pattern; the order of
  /// elimination is kept.
  void refactor();
  void solve(const Vector& right_hand_side, Vector& solution) const;
  /// Solution without refinement, for iterations that correct its error.
  void solve_once(const Vector& right_hand_side, Vector& solution) const;
  /// Solutions for several right-hand sides at once, without refinement; the cost is about that of
  /// two solutions.
  Columns solve(const Columns& right_hand_sides) const;
  FactorCost cost() const;

 private:
  const Matrix& matrix_;
  Product product_;
  std::unique_ptr<SparseFactors> factors_;
};

}  // namespace vibrissa::fem
