#pragma once

#include <mpi.h>

#include <memory>

namespace vibrissa::fem {

/// Starts MPI and PETSc, unless a session has done so already, and stops what it started at the end
/// of its life. To be made before anything else of this room is used; MPI starts once only.
class SolverSession {
 public:
  SolverSession();
  ~SolverSession();
  SolverSession(const SolverSession&) = delete;
  SolverSession& operator=(const SolverSession&) = delete;

  /// All processes, kept apart for what they say to each other about failures.
  static MPI_Comm failure_communicator();

 private:
  struct Session;
  std::unique_ptr<Session> session_;
};

}  // namespace vibrissa::fem
