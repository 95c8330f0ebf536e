#include <cstring>
#include <exception>
#include <iostream>

#include "apps/blas_kernel.h"
#include "apps/command.h"
#include "diagnosis/diagnosis.h"
#include "report/revision.h"
#include "signals/error.h"

namespace {

constexpr int bad_input = 2, too_poor_data = 3, internal_error = 70, interrupted = 130;

constexpr const char* about =
    "Vibrissa: why the whisker or airflow sensor on the bench differs from the one in the "
    "simulation.\n"
    "Simulates the sensor, identifies its base vibration response and separates wind from "
    "vibration.";
constexpr const char* footer =
    "Examples:\n"
    "  vibrissa run cases/flow_sensor.prm\n"
    "  vibrissa modes cases/whisker_sensor.prm --json\n"
    "  vibrissa plan --sim simulated --out plan\n"
    "  vibrissa diagnose --sim simulated --real bench --out diagnosis\n"
    "  vibrissa identify recording.csv --column base_acceleration=z_mps2 --rate 500\n"
    "Exit status: 0 done, 2 bad input (the message says what and where), 3 too little "
    "data to say anything, 70 a fault of ours, 130 interrupted.";

int run(int argc, char** argv) {
  CLI::App app(about, "vibrissa");
  app.footer(footer);
  app.set_version_flag("--version",
                       std::string("vibrissa ") + vibrissa::report::program_revision());
  app.require_subcommand(1);
  vibrissa::apps::add_run_command(app);
  vibrissa::apps::add_modes_command(app);
  vibrissa::apps::add_mesh_command(app);
  vibrissa::apps::add_simulate_command(app);
  vibrissa::apps::add_transient_command(app);
  vibrissa::apps::add_static_command(app);
  vibrissa::apps::add_bode_command(app);
  vibrissa::apps::add_excite_command(app);
  vibrissa::apps::add_identify_command(app);
  vibrissa::apps::add_separate_command(app);
  vibrissa::apps::add_plan_command(app);
  vibrissa::apps::add_diagnose_command(app);
  vibrissa::apps::add_reproduce_command(app);
  vibrissa::apps::add_trial_command(app);
  vibrissa::apps::add_benchmark_command(app);
  vibrissa::apps::add_draw_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : bad_input;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  vibrissa::apps::use_fast_blas_kernel(argv);
  try {
    return run(argc, argv);
  } catch (const vibrissa::signals::UserError& error) {
    std::cerr << "vibrissa: " << error.what() << std::endl;
    return bad_input;
  } catch (const vibrissa::diagnosis::TooPoorData& error) {
    std::cerr << "vibrissa: " << error.what() << std::endl;
    return too_poor_data;
  } catch (const vibrissa::apps::Interrupted& error) {
    std::cerr << "vibrissa: " << error.what() << std::endl;
    return interrupted;
  } catch (const std::exception& error) {
    std::cerr
        << "vibrissa: internal error: " << error.what()
        << "\nThis is a fault of the program; please report it with the command that you gave."
        << std::endl;
    return internal_error;
  }
}
