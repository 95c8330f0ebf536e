#pragma once

#include <functional>
#include <memory>

#include "fem/factors/sparse_factors.h"

namespace vibrissa::fem {

/// Sparse Cholesky factors of a symmetric positive definite matrix, kept for any number of solves,
/// each of a single vector with one step of iterative refinement. Throws IndefiniteMatrix
/// when the matrix is not positive definite, signals::UserError or std::bad_alloc when memory runs
/// out. The matrix must outlive the factors. Proven by tests/fem/factors/cholesky_solver_test.cc.
class CholeskySolver {
 public:
  /// Product with the matrix for the refinement, where the assembled one is not exact enough;
  /// nothing: the matrix itself.
  using Product = std::function<void(const Vector& x, Vector& product)>;
  explicit CholeskySolver(const Matrix& matrix, Product product = {});
  /// Anew, after the matrix changed its values but not its pattern: keeps the order of elimination.
  void refactor();
  void solve(const Vector& right_hand_side, Vector& solution) const;
  /// Without refinement, for iterations that correct themselves.
  void solve_once(const Vector& right_hand_side, Vector& solution) const;
  /// Several right-hand sides at once, without refinement: about the price of two.
  Columns solve(const Columns& right_hand_sides) const;
  FactorCost cost() const;

 private:
  const Matrix& matrix_;
  Product product_;
  std::unique_ptr<SparseFactors> factors_;
};

}  // namespace vibrissa::fem
