#include "apps/command_line/program_run.h"

#include <csignal>
#include <exception>
#include <iostream>
#include <new>

#include "apps/command_line/command.h"
#include "apps/command_line/help_formatter.h"
#include "apps/command_line/parse_advice.h"
#include "diagnosis/diagnosis.h"
#include "signals/base/error.h"
#include "signals/base/exit_status.h"
#include "signals/base/revision.h"
#include "signals/system/kept_memory.h"

namespace vibrissa::apps {
namespace {

namespace exit_status = signals::exit_status;

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

int parse(CLI::App& app, int argc, char** argv) {
  // --help behind it would hide that there is no such command.
  if (const std::string advice = command_advice(app, argc, argv); !advice.empty())
    throw signals::UserError(advice);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) {
      if (const std::string advice = parse_advice(app, argc, argv); !advice.empty())
        std::cerr << "vibrissa: " << advice << "\n";
    }
    return app.exit(error) == 0 ? 0 : exit_status::bad_input;
  }
  return 0;
}

Outcome outcome_of(const std::exception& error,
                   const std::function<bool(const std::exception&)>& is_out_of_memory) {
  if (dynamic_cast<const signals::UserError*>(&error))
    return {exit_status::bad_input, error.what()};
  if (dynamic_cast<const diagnosis::TooLittleData*>(&error))
    return {exit_status::too_little_data, error.what()};
  if (dynamic_cast<const signals::ResourceError*>(&error))
    return {exit_status::no_resource, error.what()};
  if (dynamic_cast<const Interrupted*>(&error)) return {exit_status::interrupted, error.what()};
  if (dynamic_cast<const std::bad_alloc*>(&error) || is_out_of_memory(error))
    return {exit_status::no_resource,
            "not enough memory; use shorter records or a coarser mesh (Model/Mesh resolution)"};
  return {exit_status::fault, std::string("internal error: ") + error.what() +
                                  "\nThis is a fault of the program; please report it with the "
                                  "command that you gave."};
}

}  // namespace

std::unique_ptr<CLI::App> tree_of(const std::span<const AddCommand> commands) {
  auto app = std::make_unique<CLI::App>(about, "vibrissa");
  // Subcommands take it over.
  app->formatter(std::make_shared<HelpFormatter>());
  app->footer(footer);
  app->set_version_flag("--version", std::string("vibrissa ") + signals::program_revision());
  app->require_subcommand(1);
  for (const AddCommand add : commands) add(*app);
  return app;
}

Outcome run_program(const std::span<const AddCommand> commands, const int argc, char** argv,
                    const std::function<void()>& before,
                    const std::function<bool(const std::exception&)>& is_out_of_memory,
                    const bool is_muted) {
  Outcome outcome;
  try {
    if (before) before();
    outcome.status = parse(*tree_of(commands), argc, argv);
  } catch (const std::exception& error) {
    outcome = outcome_of(error, is_out_of_memory);
  }
  if (!is_muted && outcome.status == 0 && !std::cout.flush())
    outcome = {exit_status::no_resource,
               "the standard output cannot be written; is the disk full?"};
  return outcome;
}

void prepare_program() {
  signals::keep_freed_memory();
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace vibrissa::apps
