#include <iostream>
#include <memory>

#include "apps/command_line/command.h"
#include "apps/solid/jobs/transient_job.h"
#include "report/figures/table.h"
#include "signals/base/error.h"

namespace vibrissa::apps {

namespace {

struct TransientCommandOptions {
  CommonOptions common;
  CaseOptions chosen;
  std::optional<std::string> resumed_folder, strain;
};

void print_substeps(const nlohmann::json& substeps) {
  std::cout << substeps["smallest"] << " to " << substeps["largest"] << " substeps a sample, "
            << report::Cell(substeps["mean"].get<double>()).rounded(3)
            << " in the mean; samples repeated: " << substeps["rejected_intervals"] << "\n";
  if (substeps["intervals_over_tolerance"] > 0)
    std::cout << "Samples above Transient/Time tolerance at the largest number of substeps: "
              << substeps["intervals_over_tolerance"] << " (substeps.csv)\n";
}

void print_outcome(const TransientOutcome& outcome) {
  const auto number = [&](const char* name) {
    return report::Cell(outcome.summary[name].get<double>()).rounded(3);
  };
  std::cout << outcome.summary["samples"] << " samples, " << outcome.summary["unknowns"]
            << " unknowns, " << outcome.summary["steps"] << " steps, "
            << outcome.summary["iterations"] << " iterations, " << outcome.summary["factorisations"]
            << " factorisations\nLargest base moment " << number("largest_base_moment_n_m")
            << " N m; its two formulas (clamp reactions, balance of angular momentum) differ by "
            << number("two_moment_routes_relative_difference") << " of it\n";
  if (outcome.summary.contains("substeps")) print_substeps(outcome.summary["substeps"]);
  if (outcome.summary.contains("energy_error_over_largest_work"))
    std::cout << "Energy balance closes to " << number("energy_error_over_largest_work")
              << " of the largest work\n";
  std::cout << "Results: " << outcome.folder.string() << "\n";
}

TransientOutcome run(TransientCommandOptions& options) {
  const bool show = options.common.is_talkative();
  if (options.resumed_folder) {
    if (!options.chosen.case_file.empty() || options.strain || !options.chosen.is_plain())
      throw signals::UserError("--resume uses the case of the folder: give no other option");
    return resume_transient(*options.resumed_folder, show);
  }
  if (options.chosen.case_file.empty())
    throw signals::UserError(
        "name a case file (.prm), or the folder of an interrupted run (--resume)");
  if (options.strain) options.chosen.settings.push_back("Transient/Strain=" + *options.strain);
  return run_transient(options.chosen, given_command_line(), show);
}

void report_outcome(const TransientOutcome& outcome, const CommonOptions& common) {
  const std::string folder = outcome.folder.string();
  if (!outcome.is_done)
    throw Interrupted("interrupted; go on with: vibrissa transient --resume '" + folder + "'");
  if (common.json) {
    auto document = outcome.summary;
    document["folder"] = folder;
    print_json(document);
  } else {
    print_outcome(outcome);
  }
}

}  // namespace

void add_transient_command(CLI::App& app) {
  const auto options = std::make_shared<TransientCommandOptions>();
  auto* command =
      app.add_subcommand("transient",
                         "Integrates the whole solid in time at finite or small strain: base "
                         "moment, energies, fields; an interrupted run can be resumed");
  options->chosen.add_to(*command, sensor_case::CaseUse::transient);
  options->chosen.add_folder_to(*command);
  command->get_option("case")->required(false);
  command->add_option("--strain", options->strain,
                      "finite or small; overrides Transient/Strain of the case file");
  command->add_option("--resume", options->resumed_folder,
                      "Resumes the run in this folder from its checkpoint; give no case then");
  add_common_options(*command, options->common);
  command->footer(
      "Examples:\n"
      "  vibrissa transient sensor.prm --duration 0.5 --output results/finite\n"
      "  vibrissa transient --resume results/finite\n"
      "  mpirun -np 2 vibrissa transient sensor.prm --strain small");
  command->callback([options] { report_outcome(run(*options), options->common); });
}

}  // namespace vibrissa::apps
