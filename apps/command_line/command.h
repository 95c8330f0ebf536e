#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace vibrissa::apps {

/// What every command takes.
struct CommonOptions {
  bool json = false;   // the result as one JSON document on standard output, nothing else there
  bool quiet = false;  // no progress bar, no remarks; warnings stay
  bool is_talkative() const { return !json && !quiet; }
};

/// Adds --json and --quiet.
void add_common_options(CLI::App& command, CommonOptions& options);

/// Checks of an option's value; their messages say what it must be.
CLI::Validator positive_number();
CLI::Validator not_negative_number();

/// The words this program was started with, for the run's own record.
std::vector<std::string> given_command_line();

/// Work that stopped because someone asked it to; says how to go on.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Prints a JSON document on standard output.
void print_json(const nlohmann::json& document);

/// Each adds its subcommand; the work happens in the subcommand's callback.
void add_benchmark_command(CLI::App& app);
void add_bode_command(CLI::App& app);
void add_check_command(CLI::App& app);
void add_completion_command(CLI::App& app);
void add_convert_command(CLI::App& app);
void add_diagnose_command(CLI::App& app);
void add_doctor_command(CLI::App& app);
void add_draw_command(CLI::App& app);
void add_excite_command(CLI::App& app);
void add_identify_command(CLI::App& app);
void add_init_command(CLI::App& app);
void add_manual_command(CLI::App& app);
void add_mesh_command(CLI::App& app);
void add_modes_command(CLI::App& app);
void add_plan_command(CLI::App& app);
void add_reproduce_command(CLI::App& app);
void add_run_command(CLI::App& app);
void add_separate_command(CLI::App& app);
void add_simulate_command(CLI::App& app);
void add_transient_command(CLI::App& app);
void add_static_command(CLI::App& app);
void add_trial_command(CLI::App& app);

}  // namespace vibrissa::apps
