#pragma once

#include <petscksp.h>

namespace vibrissa::fem {

/// The settings that every factorisation of ours shares, applied to a PETSc solver: MUMPS Cholesky
/// ...
void use_mumps_cholesky(KSP solver);
/// ... with METIS ordering (after the operators are set) ...
void order_with_metis(KSP solver);
/// ... whose outcome is checked (after set-up): UserError when not positive definite or out of
/// memory.
void check_factors(KSP solver);

}  // namespace vibrissa::fem
