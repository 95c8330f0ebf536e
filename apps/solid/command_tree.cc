#include "apps/solid/command_tree.h"

#include "apps/command_line/command.h"

namespace vibrissa::apps {

std::span<const AddCommand> all_commands() {
  // In the order of --help.
  static constexpr AddCommand commands[] = {
      add_init_command,       add_run_command,       add_modes_command,    add_mesh_command,
      add_simulate_command,   add_transient_command, add_static_command,   add_bode_command,
      add_excite_command,     add_check_command,     add_identify_command, add_separate_command,
      add_convert_command,    add_plan_command,      add_diagnose_command, add_reproduce_command,
      add_trial_command,      add_benchmark_command, add_draw_command,     add_doctor_command,
      add_completion_command, add_manual_command};
  return commands;
}

std::unique_ptr<CLI::App> command_tree() {
  return tree_of(all_commands());
}

}  // namespace vibrissa::apps
