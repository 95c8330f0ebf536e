#include "fem/linalg/solver_session.h"

#include <deal.II/base/mpi.h>
#include <petscsys.h>

#include <cstdlib>

#include "fem/linalg/linear_algebra.h"

namespace vibrissa::fem {

namespace {

bool is_running = false;
MPI_Comm of_failures = MPI_COMM_NULL;

}  // namespace

struct SolverSession::Session {
  int n_arguments = 0;
  char** arguments = nullptr;
  dealii::Utilities::MPI::MPI_InitFinalize mpi{n_arguments, arguments, 1};
};

SolverSession::SolverSession() {
  if (is_running) return;
  // A single process needs no daemon of Open MPI.
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  session_ = std::make_unique<Session>();
  is_running = true;
  MPI_Comm_dup(MPI_COMM_WORLD, &of_failures);
  // Errors are returned as codes, which become exceptions; the program handles signals.
  check_petsc(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr), "PetscPushErrorHandler");
  check_petsc(PetscPopSignalHandler(), "PetscPopSignalHandler");
}

SolverSession::~SolverSession() {
  if (session_) is_running = false;
}

MPI_Comm SolverSession::failure_communicator() {
  return of_failures;
}

}  // namespace vibrissa::fem
