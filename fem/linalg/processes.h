#pragma once

#include <cstddef>
#include <string>

namespace vibrissa::fem {

/// The processes that work on one solid (MPI_COMM_WORLD). Before MPI is started, and without
/// mpirun: one. What is printed or written beside the solid's parts is the first one's affair.
bool is_first_process();
std::size_t n_processes();

/// Whether a launcher (mpirun, srun) started this program as one of several; tells before MPI is
/// started.
bool is_launched_as_several();

/// The first process's text, on all. Collective.
std::string from_first_process(const std::string& text);

/// After a failure: waits a moment for the other processes to fail, too. All that went wrong alike
/// must call it again once the message is out, so that none ends the job before.
bool all_processes_failed();

/// Ends the other processes as well, wherever they are. For a failure that is this one's alone.
[[noreturn]] void end_all_processes(int exit_status);

}  // namespace vibrissa::fem
