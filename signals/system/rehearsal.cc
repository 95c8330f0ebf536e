#include "signals/system/rehearsal.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>

#include "signals/base/error.h"

namespace vibrissa::signals {

namespace {

constexpr int memory_exceeded = 71;  // exit status

std::size_t enough_mb(const std::size_t n_bytes) {
  return 512 + n_bytes / 10'000;
}

long peak_resident_kb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

// Of the child. Pages that the system provides take no time of its own, which is all that a loop
// without end takes.
volatile long most_resident_kb = 0, most_own_s = 0;

void end_if_memory_exceeded() {
  if (peak_resident_kb() > most_resident_kb) _exit(memory_exceeded);
}

void end_if_too_much(int) {
  end_if_memory_exceeded();
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  if (usage.ru_utime.tv_sec >= most_own_s) std::raise(SIGXCPU);
}

long enough_s(const std::size_t n_bytes) {
  return static_cast<long>(2 + n_bytes / 100'000);
}

/// Checks the resident memory and the time every 10 ms of CPU time. A memory limit of the operating
/// system would make the library fail in another way than in the real reading.
void bound_memory_and_time(const std::size_t n_bytes) {
  most_resident_kb = peak_resident_kb() + static_cast<long>(1024 * enough_mb(n_bytes));
  most_own_s = enough_s(n_bytes);
  struct sigaction action {};
  action.sa_handler = end_if_too_much;
  action.sa_flags = SA_RESTART;
  sigaction(SIGPROF, &action, nullptr);
  const itimerval often{{0, 10'000}, {0, 10'000}};
  setitimer(ITIMER_PROF, &often, nullptr);
}

/// Restores the default crash signals, limits the CPU time with the system's share of it, and
/// silences the process: no core file and no output.
void set_crash_defaults(const std::size_t n_bytes) {
  for (const int crash : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU})
    std::signal(crash, SIG_DFL);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  const auto most_s = static_cast<rlim_t>(10 * enough_s(n_bytes));
  const rlimit cpu_time{most_s, most_s + 1};  // at the hard limit the process is killed
  setrlimit(RLIMIT_CPU, &cpu_time);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0) return;
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
}

[[noreturn]] void run_in_child(const std::size_t n_bytes, const std::function<void()>& reading) {
  set_crash_defaults(n_bytes);
  bound_memory_and_time(n_bytes);
  try {
    reading();
  } catch (...) {
  }
  end_if_memory_exceeded();
  // _exit, not exit: the child must not flush or remove what it inherited from its parent.
  _exit(0);
}

}  // namespace

void rehearse(const std::string& file, const std::size_t n_bytes,
              const std::function<void()>& reading) {
  const pid_t child = fork();
  if (child == 0) run_in_child(n_bytes, reading);
  if (child < 0) {
    const int reason = errno;
    throw ResourceError(
        file + ": cannot start a process to read it: " + std::generic_category().message(reason));
  }
  int status = 0;
  pid_t ended = 0;
  do {
    ended = waitpid(child, &status, 0);
  } while (ended < 0 && errno == EINTR);
  // The result is unknown when other code has already waited for all children or ignores them.
  if (ended != child || status == 0) return;
  if (WIFEXITED(status) && WEXITSTATUS(status) == memory_exceeded)
    throw UserError(
        file + ": reading its " + std::to_string(n_bytes) + " bytes takes more than " +
        std::to_string(enough_mb(n_bytes)) +
        " MB of memory, so it is probably damaged; write it again, or give its columns as CSV");
  const std::string end = WIFSIGNALED(status) ? strsignal(WTERMSIG(status)) : "an early exit";
  throw UserError(file + ": is damaged: the library that reads such files crashes on it (" + end +
                  "); write it again, or give its columns as CSV");
}

}  // namespace vibrissa::signals
