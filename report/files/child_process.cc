#include "report/files/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <sstream>

extern char** environ;

namespace vibrissa::report {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

class Pipe {
 public:
  Pipe() { made_ = ::pipe2(ends_.data(), O_CLOEXEC) == 0; }
  ~Pipe() {
    close(read_end());
    close(write_end());
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  bool made() const { return made_; }
  int& read_end() { return ends_[0]; }
  int& write_end() { return ends_[1]; }
  static void close(int& end) {
    if (end >= 0) ::close(end);
    end = -1;
  }

 private:
  std::array<int, 2> ends_ = {-1, -1};
  bool made_;
};

/// Returns 0 or the system's error number. The child writes standard output and error to output.
int spawn(const std::vector<std::string>& command, const int output, pid_t& pid) {
  std::vector<char*> arguments;
  for (const auto& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, output, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  const int error =
      ::posix_spawn(&pid, arguments[0], &files, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return error;
}

/// One running child: collects its output and waits for its end.
class Child {
 public:
  Child(const pid_t pid, const int output) : pid_(pid), output_(output) {
    ::fcntl(output_, F_SETFL, O_NONBLOCK);
  }

  /// Did the child end before the deadline?
  bool wait_until(const Clock::time_point deadline,
                  const std::function<void()>& while_waiting = {}) {
    while (!has_ended()) {
      if (while_waiting) while_waiting();
      const auto left = std::chrono::duration_cast<milliseconds>(deadline - Clock::now());
      if (left <= milliseconds(0)) return false;
      wait_for_output(std::min(left, milliseconds(20)));
      collect();
    }
    return true;
  }

  /// Sends the termination signal to the child's process group.
  void ask_to_end() const { ::kill(-pid_, SIGTERM); }

  /// Kills the rest of the group and records how the child ended. The process id, and so the group
  /// id, cannot be reused before the child is waited for.
  void finish(ChildResult& result) {
    ::kill(-pid_, SIGKILL);
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    collect();
    result.output = text_;
    result.end = WIFSIGNALED(status) ? ChildResult::End::killed : ChildResult::End::exited;
    result.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
  }

 private:
  bool has_ended() const {
    siginfo_t information{};
    return ::waitid(P_PID, static_cast<id_t>(pid_), &information, WEXITED | WNOHANG | WNOWAIT) ==
               0 &&
           information.si_pid == pid_;
  }

  /// A closed pipe would always be ready although the child may still run.
  void wait_for_output(const milliseconds time) {
    pollfd ready{closed_ ? -1 : output_, POLLIN, 0};
    ::poll(&ready, 1, static_cast<int>(time.count()));
  }

  void collect() {
    constexpr std::size_t most = 1 << 20;
    std::array<char, 4096> block;
    ssize_t n;
    while ((n = ::read(output_, block.data(), block.size())) > 0)
      if (text_.size() < most) text_.append(block.data(), static_cast<std::size_t>(n));
    closed_ = n == 0;
  }

  pid_t pid_;
  int output_;
  bool closed_ = false;
  std::string text_;
};

}  // namespace

std::string ChildResult::what_happened() const {
  switch (end) {
    case End::exited:
      return "ended with status " + std::to_string(code);
    case End::killed:
      return "was ended by signal " + std::to_string(code) + " (" + ::strsignal(code) + ")";
    case End::out_of_time:
      return "did not end within its time limit";
    case End::not_started:
      return std::string("could not be started: ") + std::strerror(code);
  }
  return "";
}

ChildResult run_child(const std::vector<std::string>& command, const double time_limit_s,
                      const std::function<void()>& while_waiting) {
  assert(!command.empty() && time_limit_s > 0.);
  ChildResult result;
  Pipe pipe;
  pid_t pid = 0;
  result.code = pipe.made() ? spawn(command, pipe.write_end(), pid) : errno;
  if (result.code != 0) return result;
  Pipe::close(pipe.write_end());
  Child child(pid, pipe.read_end());
  const auto limit =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_limit_s));
  const bool in_time = child.wait_until(Clock::now() + limit, while_waiting);
  if (!in_time) {
    child.ask_to_end();
    child.wait_until(Clock::now() + std::chrono::seconds(2));
  }
  child.finish(result);
  if (!in_time) result.end = ChildResult::End::out_of_time;
  return result;
}

std::string find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string file = (folder.empty() ? "." : folder) + "/" + name;
    if (::access(file.c_str(), X_OK) == 0) return file;
  }
  return "";
}

}  // namespace vibrissa::report
