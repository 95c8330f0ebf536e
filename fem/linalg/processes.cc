#include "fem/linalg/processes.h"

#include <mpi.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "fem/linalg/solver_session.h"

namespace vibrissa::fem {

namespace {

using Clock = std::chrono::steady_clock;

bool mpi_runs() {
  int started = 0, ended = 0;
  MPI_Initialized(&started);
  MPI_Finalized(&ended);
  return started != 0 && ended == 0;
}

int number_of_process() {
  int rank = 0;
  if (mpi_runs()) MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

}  // namespace

bool is_first_process() {
  return number_of_process() == 0;
}

std::size_t n_processes() {
  int n = 1;
  if (mpi_runs()) MPI_Comm_size(MPI_COMM_WORLD, &n);
  return static_cast<std::size_t>(n);
}

bool is_launched_as_several() {
  // Open MPI; MPICH, Intel MPI; Slurm.
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"}) {
    const char* const value = std::getenv(name);
    if (value != nullptr && std::atoi(value) > 1) return true;
  }
  return false;
}

std::string from_first_process(const std::string& text) {
  if (n_processes() == 1) return text;
  unsigned long size = text.size();
  MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG, 0, MPI_COMM_WORLD);
  std::string result = text;
  result.resize(size);
  MPI_Bcast(result.data(), static_cast<int>(size), MPI_CHAR, 0, MPI_COMM_WORLD);
  return result;
}

bool all_processes_failed() {
  // Several processes may fail separately at the same time: the first one ends the others, and its
  // message is shown.
  const auto patience = std::chrono::milliseconds(2000 + 500 * number_of_process());
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibarrier(SolverSession::failure_communicator(), &request);
  for (const auto end = Clock::now() + patience; Clock::now() < end;
       std::this_thread::sleep_for(std::chrono::milliseconds(5))) {
    int done = 0;
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done != 0) return true;
  }
  return false;
}

void end_all_processes(const int exit_status) {
  MPI_Abort(MPI_COMM_WORLD, exit_status);
  std::_Exit(exit_status);
}

}  // namespace vibrissa::fem
