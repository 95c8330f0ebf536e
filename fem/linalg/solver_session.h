#pragma once

#include <mpi.h>

#include <memory>

namespace vibrissa::fem {

/// Starts MPI and PETSc, unless another session has already done so, and stops them at the end of
/// its lifetime. Create it before any other object of fem/; MPI can be started only once.
class SolverSession {
 public:
  SolverSession();
  ~SolverSession();
  SolverSession(const SolverSession&) = delete;
  SolverSession& operator=(const SolverSession&) = delete;

  /// Communicator of all processes, only for messages about failures.
  static MPI_Comm failure_communicator();

 private:
  struct Session;
  std::unique_ptr<Session> session_;
};

}  // namespace vibrissa::fem
