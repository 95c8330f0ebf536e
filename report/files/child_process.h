#pragma once

#include <functional>
#include <string>
#include <vector>

namespace vibrissa::report {

/// End of a child process, and its standard output and standard error.
struct ChildResult {
  enum class End { exited, killed, out_of_time, not_started } end = End::not_started;
  int code = 0;  // exit status, signal number or system error number
  std::string output;

  bool succeeded() const { return end == End::exited && code == 0; }
  /// "ended with status 1", "was ended by signal 6 (Aborted)", "did not end within its time limit",
  /// ...
  std::string what_happened() const;
};

/// Runs command[0], a path, with the other words as arguments, without a shell, with empty standard
/// input, in its own process group. When it ends, or after time_limit_s, this process group (and no
/// other process) is ended. while_waiting: called many times a second until then. Proven by
/// tests/report/files/child_process_test.cc.
ChildResult run_child(const std::vector<std::string>& command, double time_limit_s,
                      const std::function<void()>& while_waiting = {});

/// Path of a program in the folders of PATH; empty when no folder contains it.
std::string find_program(const std::string& name);

}  // namespace vibrissa::report
