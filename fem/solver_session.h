#pragma once

#include <memory>

namespace vibrissa::fem {

/// Starts MPI and PETSc and stops them at the end of its life. One per process, before
/// anything else of this room is used.
class SolverSession {
 public:
  SolverSession();
  ~SolverSession();
  SolverSession(const SolverSession&) = delete;
  SolverSession& operator=(const SolverSession&) = delete;

 private:
  struct Session;
  std::unique_ptr<Session> session_;
};

}  // namespace vibrissa::fem
