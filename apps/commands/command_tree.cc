#include "apps/commands/command_tree.h"

#include <string>

#include "apps/command_line/command.h"
#include "apps/command_line/help_formatter.h"
#include "signals/base/revision.h"

namespace vibrissa::apps {
namespace {

constexpr const char* about =
    "Vibrissa: why the whisker or airflow sensor on the bench differs from the one in the "
    "simulation.\n"
    "Simulates the sensor, identifies its base vibration response and separates wind from "
    "vibration.";
constexpr const char* footer =
    "Examples:\n"
    "  vibrissa run cases/flow_sensor.prm\n"
    "  vibrissa modes cases/whisker_sensor.prm --json\n"
    "  vibrissa check recording.csv\n"
    "  vibrissa plan --sim simulated --out plan\n"
    "  vibrissa diagnose --sim simulated --real bench --out diagnosis\n"
    "  vibrissa identify recording.csv --column base_acceleration=z_mps2 --rate 500\n"
    "Exit status: 0 done, 2 bad input (the message says what and where), 3 too little "
    "data to say anything, 70 a fault of the program, 74 memory, disk or output, 130 interrupted.";

}  // namespace

std::unique_ptr<CLI::App> command_tree() {
  auto app = std::make_unique<CLI::App>(about, "vibrissa");
  // Subcommands take it over.
  app->formatter(std::make_shared<HelpFormatter>());
  app->footer(footer);
  app->set_version_flag("--version", std::string("vibrissa ") + signals::program_revision());
  app->require_subcommand(1);
  // In the order of --help.
  for (const auto add :
       {add_init_command,       add_run_command,       add_modes_command,    add_mesh_command,
        add_simulate_command,   add_transient_command, add_static_command,   add_bode_command,
        add_excite_command,     add_check_command,     add_identify_command, add_separate_command,
        add_convert_command,    add_plan_command,      add_diagnose_command, add_reproduce_command,
        add_trial_command,      add_benchmark_command, add_draw_command,     add_doctor_command,
        add_completion_command, add_manual_command})
    add(*app);
  return app;
}

}  // namespace vibrissa::apps
