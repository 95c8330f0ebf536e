#include "fem/factors/cholesky_solver.h"

#include <utility>

namespace vibrissa::fem {

CholeskySolver::CholeskySolver(const Matrix& matrix, Product product)
    : matrix_(matrix), product_(std::move(product)), factors_(make_factors(matrix)) {
  refactor();
}

void CholeskySolver::refactor() {
  factors_->factorise();
}

void CholeskySolver::solve(const Vector& right_hand_side, Vector& solution) const {
  solve_once(right_hand_side, solution);
  // The stiffnesses of a slender solid differ by many orders of magnitude: one step of refinement
  // removes the unbalanced forces from the rounding of the factors, which have long lever arms.
  Vector residual(right_hand_side), correction(right_hand_side);
  if (product_) {
    product_(solution, residual);
  } else {
    matrix_.vmult(residual, solution);
  }
  residual.sadd(-1., right_hand_side);
  solve_once(residual, correction);
  solution += correction;
}

void CholeskySolver::solve_once(const Vector& right_hand_side, Vector& solution) const {
  factors_->solve(right_hand_side, solution);
}

Columns CholeskySolver::solve(const Columns& right_hand_sides) const {
  return factors_->solve(right_hand_sides);
}

FactorCost CholeskySolver::cost() const {
  return factors_->cost();
}

}  // namespace vibrissa::fem
