#pragma once

#include <vector>

#include "fem/factors/cholesky_solver.h"

namespace vibrissa::fem {

struct Eigenpair {
  double eigenvalue = 0.;
  Vector vector;  // x^T M x = 1
};

/// The n smallest eigenpairs of K x = lambda M x, ascending (fewer when the problem has fewer), and
/// n_beyond further pairs. A further pair is converged only when its eigenvalue may equal the nth
/// one: a group of equal eigenvalues is complete, without the cost of other pairs. Block Lanczos
/// with full reorthogonalisation for K^-1 M (Golub and Van Loan, Matrix Computations, 4th ed.,
/// 10.3), M positive semi-definite. A block method finds repeated eigenvalues (the bending pairs
/// of a round sensor) as fast as single ones. One block costs about as much as two vectors, because
/// the factors are read once for all columns. Throws UserError when they do not converge. Proven by
/// tests/fem/solvers/block_lanczos_test.cc.
std::vector<Eigenpair> smallest_eigenpairs(const CholeskySolver& stiffness, const Matrix& mass,
                                           unsigned int n, unsigned int n_beyond = 0);

}  // namespace vibrissa::fem
