#pragma once

#include <vector>

#include "fem/factors/cholesky_solver.h"

namespace vibrissa::fem {

struct Eigenpair {
  double eigenvalue = 0.;
  Vector vector;  // x^T M x = 1
};

/// The n smallest eigenpairs of K x = lambda M x, ascending, unless the problem has fewer, and
/// n_beyond more that have converged only where they are not apart from the nth: so that a pair of
/// equal ones is whole without the price of one that nobody asked for. Block Lanczos with full
/// reorthogonalisation for K^-1 M (Golub and Van Loan, Matrix Computations, 4th ed., 10.3.6), M
/// positive semi-definite. A block finds repeated eigenvalues (the bending pairs of a round sensor)
/// as fast as single ones, and one block costs about as much as two vectors, because the factors
/// are read once for all its columns. Throws UserError when they do not converge. Proven by
/// tests/fem/solvers/block_lanczos_test.cc.
std::vector<Eigenpair> smallest_eigenpairs(const CholeskySolver& stiffness, const Matrix& mass,
                                           unsigned int n, unsigned int n_beyond = 0);

}  // namespace vibrissa::fem
