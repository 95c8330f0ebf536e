#include "fem/solver_session.h"

#include <deal.II/base/mpi.h>
#include <petscsys.h>

#include "fem/linear_algebra.h"

namespace vibrissa::fem {

struct SolverSession::Session {
  int n_arguments = 0;
  char** arguments = nullptr;
  dealii::Utilities::MPI::MPI_InitFinalize mpi{n_arguments, arguments, 1};
};

SolverSession::SolverSession() : session_(std::make_unique<Session>()) {
  // Errors come back as codes, which we turn into exceptions; signals are the program's affair.
  check_petsc(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr), "PetscPushErrorHandler");
  check_petsc(PetscPopSignalHandler(), "PetscPopSignalHandler");
}

SolverSession::~SolverSession() = default;

}  // namespace vibrissa::fem
