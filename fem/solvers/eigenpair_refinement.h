#pragma once

#include <functional>
#include <vector>

#include "fem/solvers/block_lanczos.h"

namespace vibrissa::fem {

/// Removes the rounding errors of the assembled stiffness from the lowest eigenpairs: one step of
/// subspace iteration X <- K^-1 M X, with a product with K in which the forces of each cell are in
/// equilibrium, and Rayleigh-Ritz (T3.4; Golub and Van Loan, Matrix Computations, 4th ed., 8.2
/// and 8.3). The lowest eigenvalue of a slender solid is ten orders of magnitude below the highest:
/// with the factors alone, two different elimination orders give first frequencies of a thin wire
/// that differ by up to 2e-7. Proven by tests/fem/solid/node_rows_test.cc and processes_test.cc.
using StiffnessProduct = std::function<void(const Vector& x, Vector& product)>;
void refine(std::vector<Eigenpair>& pairs, const CholeskySolver& stiffness,
            const StiffnessProduct& product, const Matrix& mass);

}  // namespace vibrissa::fem
