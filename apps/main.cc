#include <algorithm>
#include <array>
#include <csignal>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "apps/command_line/blas_kernel.h"
#include "apps/command_line/command.h"
#include "apps/command_line/parse_advice.h"
#include "apps/commands/command_tree.h"
#include "diagnosis/diagnosis.h"
#include "fem/linalg/memory_error.h"
#include "fem/linalg/processes.h"
#include "fem/linalg/solver_session.h"
#include "signals/base/error.h"
#include "signals/base/exit_status.h"
#include "signals/system/kept_memory.h"

namespace {

namespace exit_status = vibrissa::signals::exit_status;

int run(int argc, char** argv) {
  const std::unique_ptr<CLI::App> app = vibrissa::apps::command_tree();
  // --help behind it would hide that there is no such command.
  if (const std::string advice = vibrissa::apps::command_advice(*app, argc, argv); !advice.empty())
    throw vibrissa::signals::UserError(advice);
  try {
    app->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) {
      if (const std::string advice = vibrissa::apps::parse_advice(*app, argc, argv);
          !advice.empty())
        std::cerr << "vibrissa: " << advice << "\n";
    }
    return app->exit(error) == 0 ? 0 : exit_status::bad_input;
  }
  return 0;
}

/// Commands that several processes do together, or share out (trial).
constexpr std::array<std::string_view, 5> of_several = {"run", "modes", "simulate", "transient",
                                                        "trial"};

/// Commands that solve no solid: a fast BLAS kernel would only delay their start.
constexpr std::array<std::string_view, 9> without_solid = {
    "init", "check", "identify", "separate", "convert", "excite", "draw", "completion", "manual"};

/// Only the first process prints, but where each has its own work.
class OutputMute {
 public:
  explicit OutputMute(const bool is_muted)
      : output_(is_muted ? std::cout.rdbuf(nullptr) : nullptr),
        errors_(is_muted ? std::cerr.rdbuf(nullptr) : nullptr) {}
  ~OutputMute() { restore(); }
  OutputMute(const OutputMute&) = delete;
  OutputMute& operator=(const OutputMute&) = delete;
  void restore() {
    if (output_ != nullptr) std::cout.rdbuf(std::exchange(output_, nullptr));
    if (errors_ != nullptr) std::cerr.rdbuf(std::exchange(errors_, nullptr));
  }

 private:
  std::streambuf *output_, *errors_;
};

struct Failure {
  int status = 0;
  std::string message;  // empty when all is well, or has been said
};

Failure attempt(int argc, char** argv, const std::string_view command) {
  try {
    const bool is_command = !command.empty() && command.front() != '-';
    if (is_command && vibrissa::fem::n_processes() > 1 &&
        std::find(of_several.begin(), of_several.end(), command) == of_several.end())
      throw vibrissa::signals::UserError("'" + std::string(command) +
                                         "' works on one process; start it without mpirun");
    return {run(argc, argv), ""};
  } catch (const vibrissa::signals::UserError& error) {
    return {exit_status::bad_input, error.what()};
  } catch (const vibrissa::diagnosis::TooLittleData& error) {
    return {exit_status::too_little_data, error.what()};
  } catch (const vibrissa::signals::ResourceError& error) {
    return {exit_status::no_resource, error.what()};
  } catch (const vibrissa::apps::Interrupted& error) {
    return {exit_status::interrupted, error.what()};
  } catch (const std::exception& error) {
    if (vibrissa::fem::is_out_of_memory(error))
      return {exit_status::no_resource,
              "not enough memory; use shorter records or a coarser mesh (Model/Mesh resolution)"};
    return {exit_status::fault, std::string("internal error: ") + error.what() +
                                    "\nThis is a fault of the program; please report it with the "
                                    "command that you gave."};
  }
}

/// What was printed must have arrived: a full disk behind a redirection is a failure.
Failure with_output_written(Failure failure) {
  if (failure.status == 0 && !std::cout.flush())
    failure = {exit_status::no_resource,
               "the standard output cannot be written; is the disk full?"};
  return failure;
}

// A failure of all is told once; one that is a single process's own ends the others, who would wait
// for it for ever.
void settle(const Failure& failure, OutputMute& mute) {
  namespace fem = vibrissa::fem;
  if (failure.status == 0) return;
  const bool several = fem::n_processes() > 1;
  const bool is_alone = several && !fem::all_processes_failed();
  if (is_alone) mute.restore();
  if (!failure.message.empty()) std::cerr << "vibrissa: " << failure.message << std::endl;
  if (is_alone) fem::end_all_processes(failure.status);
  if (several) fem::all_processes_failed();
}

}  // namespace

int main(int argc, char** argv) {
  namespace fem = vibrissa::fem;
  const std::string_view command = argc > 1 ? argv[1] : "";
  if (std::ranges::find(without_solid, command) == without_solid.end())
    vibrissa::apps::use_fast_blas_kernel(argv);
  vibrissa::signals::keep_freed_memory();
  // Pictures are drawn by a child of a process that may be one of several.
  std::optional<fem::SolverSession> session;
  if (fem::is_launched_as_several() && command != "draw") session.emplace();
  // A file that grows beyond a limit is an error like a full disk, not the end without a word.
  std::signal(SIGXFSZ, SIG_IGN);
  const bool is_muted = !fem::is_first_process() && command != "trial";
  OutputMute mute(is_muted);
  Failure failure = attempt(argc, argv, command);
  if (!is_muted) failure = with_output_written(std::move(failure));
  settle(failure, mute);
  return failure.status;
}
