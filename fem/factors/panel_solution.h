#pragma once

#include "fem/factors/front_layout.h"
#include "fem/linalg/linear_algebra.h"

namespace vibrissa::fem {

/// x turns into (L L^T)^-1 x, with the unknowns in the order of the factor's columns. The factor is
/// read once forwards and once backwards, which is what it costs.
/// Proven by tests/fem/factors/cholesky_solver_test.cc.
void solve_by_panels(const FrontLayout& layout, const double* factor, Columns& x);

}  // namespace vibrissa::fem
