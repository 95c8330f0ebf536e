#pragma once

#include <cstddef>
#include <string>

namespace vibrissa::fem {

/// Whether this process is the first one, and the number of processes that work on one solid
/// (MPI_COMM_WORLD); true and 1 before the start of MPI and without mpirun. The first process
/// prints and writes everything except the parts of the solid.
bool is_first_process();
std::size_t n_processes();

/// Whether a launcher (mpirun, srun) started this program as one of several processes; valid before
/// the start of MPI.
bool is_launched_as_several();

/// The text of the first process, on all processes. Collective.
std::string from_first_process(const std::string& text);

/// Call after a failure: waits a short time for the other processes, and returns whether all
/// failed. When all processes failed equally, they must call it again after the message was
/// printed, so that no process ends the job earlier.
bool all_processes_failed();

/// Ends all other processes at once, for a failure of this process alone.
[[noreturn]] void end_all_processes(int exit_status);

}  // namespace vibrissa::fem
