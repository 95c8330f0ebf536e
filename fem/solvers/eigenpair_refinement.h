#pragma once

#include <functional>
#include <vector>

#include "fem/solvers/block_lanczos.h"

namespace vibrissa::fem {

/// Takes the rounding of the assembled stiffness out of its lowest eigenpairs: one step of subspace
/// iteration X <- K^-1 M X, with a product with K that keeps each cell's forces in balance, and
/// Rayleigh-Ritz (T3.4; Golub and Van Loan, Matrix Computations, 4th ed., 8.2.4). A slender
/// body's lowest eigenvalue lies ten orders below the highest: by the factors alone, two orders of
/// elimination give a thin wire's first frequency up to 2e-7 apart. Proven by
/// tests/fem/solid/node_rows_test.cc and processes_test.cc.
using StiffnessProduct = std::function<void(const Vector& x, Vector& product)>;
void refine(std::vector<Eigenpair>& pairs, const CholeskySolver& stiffness,
            const StiffnessProduct& product, const Matrix& mass);

}  // namespace vibrissa::fem
