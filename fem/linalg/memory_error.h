#pragma once

#include <exception>

namespace vibrissa::fem {

/// Whether a PETSc error code means that there is not enough memory.
bool is_of_memory(int petsc_error_code);

/// Whether an exception means that there is not enough memory: std::bad_alloc, or the exception of
/// deal.II for such a PETSc error. Proven by tests/fem/linalg/memory_error_test.cc and
/// tests/faults/visit_fault_points.py.
bool is_out_of_memory(const std::exception& error);

}  // namespace vibrissa::fem
