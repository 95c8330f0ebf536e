#include "tests/faults/fault_child.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

namespace vibrissa::faults {
namespace {

namespace fs = std::filesystem;

constexpr int by_signal = 1000, several_threads = 2000;
constexpr int time_limit_s = 300, look_every_us = 500;

[[noreturn]] void give_up(const char* why) {
  std::perror(why);
  std::_Exit(99);
}

/// Whether a thread does nothing but wait for events, as Open MPI's does all the time.
bool waits_for_events(const fs::path& thread) {
  long call = -1;
  std::ifstream(thread / "syscall") >> call;
#ifdef SYS_poll  // not on every processor
  if (call == SYS_poll || call == SYS_epoll_wait) return true;
#endif
  return call == SYS_ppoll || call == SYS_epoll_pwait;
}

/// A child has this thread alone.
bool would_miss_a_thread() {
  const std::string self = std::to_string(gettid());
  for (const auto& thread : fs::directory_iterator("/proc/self/task"))
    if (thread.path().filename() != self && !waits_for_events(thread.path())) return true;
  return false;
}

int status_of(const pid_t child) {
  int status = 0;
  for (long waited_us = 0; waitpid(child, &status, WNOHANG) == 0; waited_us += look_every_us) {
    if (waited_us > time_limit_s * 1'000'000L) {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      break;
    }
    usleep(look_every_us);
  }
  return WIFSIGNALED(status) ? by_signal + WTERMSIG(status) : WEXITSTATUS(status);
}

/// A file that was open when the child came to be is the job's, with its place in the file.
void reopen(const int file, const std::string& path) {
  const int flags = fcntl(file, F_GETFL), descriptor_flags = fcntl(file, F_GETFD);
  const int copy = open(path.c_str(), flags & ~(O_CREAT | O_EXCL | O_TRUNC));
  if (copy < 0) give_up(path.c_str());
  lseek(copy, lseek(file, 0, SEEK_CUR), SEEK_SET);
  dup2(copy, file);
  fcntl(file, F_SETFD, descriptor_flags);
  close(copy);
}

}  // namespace

FaultChildren::FaultChildren(const std::string& folder, const std::string& talk)
    : folder_(folder), kept_(folder + ".kept") {
  if (std::sscanf(talk.c_str(), "%d,%d", &from_judge_, &to_judge_) != 2) give_up(talk.c_str());
}

void FaultChildren::set_folder_aside() const {
  if (!fs::exists(folder_)) return;
  fs::rename(folder_, kept_);
  fs::copy(kept_, folder_, fs::copy_options::recursive);
}

void FaultChildren::bring_folder_back() const {
  fs::remove_all(folder_);
  if (fs::exists(kept_)) fs::rename(kept_, folder_);
}

void FaultChildren::become_child() const {
  close(from_judge_);
  close(to_judge_);
  const int said = open((folder_ + ".said").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (said < 0) give_up("what the child says");
  dup2(said, STDOUT_FILENO);
  dup2(said, STDERR_FILENO);
  close(said);
  std::vector<int> files;
  for (const auto& entry : fs::directory_iterator("/proc/self/fd"))
    files.push_back(std::stoi(entry.path().filename()));
  for (const int file : files) {
    std::error_code closed_since;
    const std::string path =
        fs::read_symlink("/proc/self/fd/" + std::to_string(file), closed_since);
    if (path.starts_with(kept_ + "/") && fs::exists(path))
      reopen(file, folder_ + path.substr(kept_.size()));
  }
}

void FaultChildren::tell(const std::string& line) const {
  char answer = 0;
  if (write(to_judge_, line.data(), line.size()) != static_cast<ssize_t>(line.size()) ||
      read(from_judge_, &answer, 1) != 1)
    give_up("the judge is gone");
}

bool FaultChildren::is_child(const std::string& what) {
  if (would_miss_a_thread()) {
    tell(what + " " + std::to_string(several_threads) + "\n");
    return false;
  }
  for (const int end : {from_judge_, to_judge_}) fcntl(end, F_SETFD, FD_CLOEXEC);
  set_folder_aside();
  const pid_t child = fork();
  if (child < 0) give_up("fork");
  if (child == 0) {
    become_child();
    return true;
  }
  const int status = status_of(child);
  tell(what + " " + std::to_string(status) + "\n");
  bring_folder_back();
  return false;
}

}  // namespace vibrissa::faults
