#include <algorithm>
#include <array>
#include <iostream>
#include <optional>
#include <string_view>
#include <utility>

#include "apps/command_line/program_run.h"
#include "apps/jobs/nominal_input.h"
#include "apps/solid/blas_kernel.h"
#include "apps/solid/command_tree.h"
#include "apps/solid/jobs/case_solver.h"
#include "fem/linalg/memory_error.h"
#include "fem/linalg/processes.h"
#include "fem/linalg/solver_session.h"
#include "report/modes/draw_scenes.h"
#include "signals/base/error.h"

namespace {

namespace apps = vibrissa::apps;
namespace fem = vibrissa::fem;

/// Commands that several processes do together, or share out (trial).
constexpr std::array<std::string_view, 5> of_several = {"run", "modes", "simulate", "transient",
                                                        "trial"};

/// Commands that solve no solid: a fast BLAS kernel would only delay their start.
constexpr std::array<std::string_view, 4> without_solid = {"init", "draw", "completion", "manual"};

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

// A failure of all is told once; one that is a single process's own ends the others, who would wait
// for it for ever.
void settle(const apps::Outcome& failure, OutputMute& mute) {
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
  const std::string_view command = argc > 1 ? argv[1] : "";
  if (std::ranges::find(without_solid, command) == without_solid.end())
    apps::use_fast_blas_kernel(argv);
  apps::prepare_program();
  // Said by draw_pictures() alone.
  if (command == "draw" && argc == 4 && std::string_view(argv[3]) == "--scenes")
    return vibrissa::report::draw_scenes(argv[2]) ? 0 : 1;
  apps::set_case_solver(apps::solve_case);
  std::optional<fem::SolverSession> session;
  if (fem::is_launched_as_several()) session.emplace();
  const bool is_muted = !fem::is_first_process() && command != "trial";
  OutputMute mute(is_muted);
  const auto check_processes = [&] {
    const bool is_command = !command.empty() && command.front() != '-';
    if (is_command && fem::n_processes() > 1 &&
        std::find(of_several.begin(), of_several.end(), command) == of_several.end())
      throw vibrissa::signals::UserError("'" + std::string(command) +
                                         "' works on one process; start it without mpirun");
  };
  const apps::Outcome outcome = apps::run_program(apps::all_commands(), argc, argv, check_processes,
                                                  fem::is_out_of_memory, is_muted);
  settle(outcome, mute);
  return outcome.status;
}
