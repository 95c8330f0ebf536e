#pragma once

#include <exception>

namespace vibrissa::fem {

/// Whether a PETSc error code says that memory ran out.
bool is_of_memory(int petsc_error_code);

/// Whether memory ran out: std::bad_alloc, or what deal.II throws when PETSc found none. Proven by
/// tests/fem/linalg/memory_error_test.cc and tests/faults/visit_fault_points.py.
bool is_out_of_memory(const std::exception& error);

}  // namespace vibrissa::fem
