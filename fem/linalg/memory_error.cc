#include "fem/linalg/memory_error.h"

#include <deal.II/lac/exceptions.h>
#include <petscsys.h>

#include <new>

namespace vibrissa::fem {

// A failed allocation in PETSc is returned as the line number of the call.
bool is_of_memory(const int petsc_error_code) {
  return petsc_error_code == PETSC_ERR_MEM || petsc_error_code >= PETSC_ERR_MAX_VALUE;
}

bool is_out_of_memory(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return true;
  const auto* petsc = dynamic_cast<const dealii::LACExceptions::ExcPETScError*>(&error);
  return petsc != nullptr && is_of_memory(petsc->error_code);
}

}  // namespace vibrissa::fem
