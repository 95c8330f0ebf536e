#pragma once

#include <functional>
#include <vector>

#include "fem/block_lanczos.h"

namespace vibrissa::fem {

/// Takes the rounding of the assembled stiffness out of its lowest eigenpairs: one step of subspace
/// iteration X <- K^-1 M X, with a product with K that keeps each cell's forces in balance, and
/// Rayleigh-Ritz (T3.4; Golub and Van Loan, Matrix Computations, 4th ed., 8.2.4). A slender body's
/// lowest eigenvalue lies ten orders below the highest: the factors alone give it to a millionth,
/// and a mesh shared by other processes gives another millionth. Proven by
/// tests/fem/processes_test.cc.
using StiffnessProduct = std::function<void(const Vector& x, Vector& product)>;
void refine(std::vector<Eigenpair>& pairs, const CholeskySolver& stiffness,
            const StiffnessProduct& product, const Matrix& mass);

}  // namespace vibrissa::fem
