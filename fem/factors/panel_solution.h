#pragma once

#include "fem/factors/front_layout.h"
#include "fem/linalg/linear_algebra.h"

namespace vibrissa::fem {

/// Replaces x by (L L^T)^-1 x, with the unknowns in the order of the columns of the factor. The
/// cost is one forward and one backward pass over the factor. Proven by
/// tests/fem/factors/cholesky_solver_test.cc.
void solve_by_panels(const FrontLayout& layout, const double* factor, Columns& x);

}  // namespace vibrissa::fem
