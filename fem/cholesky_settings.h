#pragma once

#include <petscksp.h>

namespace vibrissa::fem {

/// The settings that every factorisation of ours shares, applied to a PETSc solver: MUMPS Cholesky
/// ...
void use_mumps_cholesky(KSP solver);
/// ... ordered by nodes, whose three unknowns follow each other (after the operators are set): a
/// graph of a third of the size, and fewer operations ...
void order_by_nodes(KSP solver);
/// ... whose outcome is checked (after set-up): UserError when not positive definite or out of
/// memory.
void check_factors(KSP solver);

}  // namespace vibrissa::fem
