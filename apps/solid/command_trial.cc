#include <array>
#include <filesystem>
#include <iostream>
#include <memory>

#include "apps/command_line/command.h"
#include "apps/command_line/programs.h"
#include "apps/command_line/results.h"
#include "apps/jobs/nominal_input.h"
#include "report/files/child_process.h"
#include "report/files/run_folder.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/system/progress.h"
#include "trial/scoring/trial_files.h"
#include "trial/scoring/trial_page.h"
#include "trial/scoring/trial_run.h"
#include "trial/scoring/trial_score.h"
#include "trial/scoring/trial_tables.h"

namespace vibrissa::apps {
namespace {

namespace fs = std::filesystem;

struct TrialCommand {
  CommonOptions common;
  fs::path folder;
  std::size_t n_cases = 20, first = 0;
  std::uint64_t seed = 1;
  trial::TrialRunOptions run;
  std::optional<fs::path> key, out;
  std::size_t n_benches = 25;
  bool finite_strain = false, life = false;
  std::array<double, 4> asked{2., 9., 2., 1.};
};

/// Sensors that the generator has begun, in the folder that it will rename when it is done.
std::size_t n_begun(const fs::path& folder) {
  std::error_code none_yet;
  std::size_t n = 0;
  for (const auto& entry : fs::directory_iterator(folder.string() + ".making", none_yet))
    n += entry.path().filename().string().starts_with("case") ? 1 : 0;
  return n;
}

/// The generator is a program of its own: it shares no code with the diagnosis.
void make(TrialCommand options) {
  if (options.folder.empty()) {
    options.folder = free_results_folder("trial");
    fs::create_directories(options.folder.parent_path());
  }
  const fs::path generator = program_beside("generate_trial");
  constexpr double a_day_s = 86400.;
  signals::Progress progress("sensors", options.n_cases, options.common.is_talkative());
  std::size_t n_shown = 0;
  std::vector<std::string> words{generator.string(), std::to_string(options.seed),
                                 std::to_string(options.first), std::to_string(options.n_cases),
                                 options.folder.string()};
  if (options.finite_strain) words.push_back("finite-strain");
  if (options.life) words.push_back("life");
  const report::ChildResult child = report::run_child(words, a_day_s, [&] {
    for (const std::size_t n = n_begun(options.folder); n_shown + 1 < n; ++n_shown)
      progress.advance();
  });
  if (!child.succeeded())
    throw signals::UserError("the generator " + child.what_happened() + ": " + child.output);
  const trial::TrialIndex trial = trial::read_trial(options.folder);
  if (options.common.json)
    return print_json({{"folder", options.folder.string()},
                       {"cases", trial.cases.size()},
                       {"labels_commitment_sha256", trial.commitment}});
  std::cout << trial.cases.size() << " sensors in " << options.folder.string()
            << "; their labels are encrypted, the key is " << options.folder.string()
            << ".key.\nThe labels have the hash (SHA-256, salted): " << trial.commitment << "\n";
}

/// As "diagnose" takes it: --model for a case file, --sim for records.
trial::TrialSimulation read_simulation(const fs::path& file) {
  NominalInput input;
  (file.extension() == ".prm" ? input.model : input.simulation) = file.string();
  const NominalInput::Simulation simulation = input.read(false);
  return {simulation.model, simulation.sampling_rate_hz()};
}

void run(const TrialCommand& options) {
  trial::TrialRunOptions settings = options.run;
  settings.read_simulation = read_simulation;
  settings.show_progress = options.common.is_talkative();
  const trial::TrialRunSummary done = trial::run_trial(options.folder, settings);
  if (!done.is_first_rank) return;
  if (options.common.json)
    return print_json({{"answered", done.answered},
                       {"refused", done.refused},
                       {"failed", done.failed},
                       {"there_before", done.there_before}});
  if (!options.common.quiet)
    std::cout << done.answered << " answered, " << done.refused << " refused, " << done.failed
              << " failed, " << done.there_before << " were there before\n";
}

void score(const TrialCommand& options) {
  const trial::TrialIndex trial = trial::read_trial(options.folder);
  const fs::path key = options.key.value_or(fs::path(options.folder.string() + ".key"));
  const trial::TrialScore score = trial::score_trial(trial, trial::open_labels(trial, key));
  if (options.common.json) return print_json(to_json(score));
  std::cout
      << "The labels are decrypted; their hash is the one of " << trial.commitment << ".\n\n"
      << (score.classes.empty() ? trial::summary_table(score) : trial::class_table(score)).to_text()
      << "\nWrong answers\n"
      << trial::confusion_table(score).to_text();
  if (score.unanswered > 0)
    std::cout << score.unanswered << " cases have no answer yet: vibrissa trial run "
              << options.folder.string() << "\n";
  const auto folder = report::RunFolder::given_or_free(options.out, options.folder / "score");
  folder.write_run({.command_line = given_command_line()});
  folder.write_text("score.json", to_json(score).dump(1) + "\n");
  folder.write_text("cases.csv", trial::case_table(score).to_csv());
  folder.write_text("summary.csv", trial::summary_table(score).to_csv());
  if (!score.classes.empty()) folder.write_text("classes.csv", trial::class_table(score).to_csv());
  folder.write_text("confusion.csv", trial::confusion_table(score).to_csv());
  for (const report::Figure& figure : trial::trial_figures(score))
    report::write_figure(folder.path(), figure);
  const auto pictures = draw_pictures(folder.path());
  report::write_page(folder.path(), trial::trial_page(score, trial.commitment));
  std::cout << pictures.message << "\nResults: " << folder.path().string() << "\n";
}

void observe(const TrialCommand& options) {
  std::vector<std::string> words{"observe_trial",
                                 "--benches",
                                 std::to_string(options.n_benches),
                                 "--seed",
                                 std::to_string(options.seed),
                                 "--asked"};
  for (const double share : options.asked) words.push_back(signals::to_text(share));
  if (options.life) words.push_back("--life");
  if (options.run.further) words.push_back("--further");
  if (options.common.json) words.push_back("--json");
  if (options.common.quiet) words.push_back("--quiet");
  become_program("observe_trial", words);
}

void add_make(CLI::App& trial, const std::shared_ptr<TrialCommand>& options) {
  auto* command = trial.add_subcommand("make",
                                       "Makes sensors, each with a hidden effect, and writes their "
                                       "records; the labels are encrypted");
  command->add_option("--cases", options->n_cases, "Number of sensors")
      ->check(positive_number())
      ->capture_default_str();
  command
      ->add_option("--first", options->first,
                   "Number of the first sensor; use it to add sensors to an earlier trial with the "
                   "same seed")
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Seed of all random draws")->capture_default_str();
  command->add_option("-o,--out,--output", options->folder,
                      "New folder (default: results/trial, or results/trial-2, ... if it exists)");
  auto* finite_strain = command->add_flag(
      "--finite-strain", options->finite_strain,
      "Simulates the whole solid at finite strain in place of its modes; the effects "
      "are drawn from a shorter list; a quarter of an hour for each sensor");
  command
      ->add_flag("--life", options->life,
                 "Draws what people bring, too: reduced sets of records, sensors that are far "
                 "from their simulation, simulations with a form error, a model in place of "
                 "simulated records; not with --finite-strain")
      ->excludes(finite_strain);
  add_common_options(*command, options->common);
  command->footer(
      "Examples:\n  vibrissa trial make --cases 40 --seed 5 --out trial5\n"
      "  vibrissa trial make --life --cases 42 --seed 6 --out life6");
  command->callback([options] { make(*options); });
}

void add_run(CLI::App& trial, const std::shared_ptr<TrialCommand>& options) {
  auto* command = trial.add_subcommand(
      "run",
      "Diagnoses every sensor that has no answer yet; the processes of mpirun share the work");
  command->add_option("folder", options->folder, "Folder of the trial")->required();
  command
      ->add_option("--max-effects", options->run.max_effects,
                   "Largest number of effects that are combined")
      ->check(CLI::Range(1, 5))
      ->capture_default_str();
  command
      ->add_option(
          "--simulation-accuracy", options->run.simulation_accuracy,
          "As for diagnose, for all sensors (default: 0.01, and 0.03 where a sensor of --life "
          "states it); 0.001 asks for effects that are smaller than the usual error of a "
          "simulation, because that of a trial of complete records is exact")
      ->check(CLI::Range(1e-4, 0.3));
  command->add_flag("--further", options->run.further,
                    "Where several answers remain, adds the recommended experiment and, for "
                    "comparison, a random one");
  command->add_option("--threads", options->run.n_threads, "Threads of each process")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->footer(
      "Examples:\n  vibrissa trial run trial5\n"
      "  mpirun -np 2 vibrissa trial run trial5 --threads 1");
  command->callback([options] { run(*options); });
}

void add_score(CLI::App& trial, const std::shared_ptr<TrialCommand>& options) {
  auto* command = trial.add_subcommand("score", "Decrypts the labels and scores the answers");
  command->add_option("folder", options->folder, "Folder of the trial")->required();
  command->add_option("--key", options->key,
                      "File with the key of the labels (default: FOLDER.key)");
  command->add_option("-o,--out,--output", options->out,
                      "New folder for tables and pictures (default: FOLDER/score)");
  add_common_options(*command, options->common);
  command->footer("Example:\n  vibrissa trial score trial5 --out score5");
  command->callback([options] { score(*options); });
}

void add_observe(CLI::App& trial, const std::shared_ptr<TrialCommand>& options) {
  auto* command = trial.add_subcommand("observe",
                                       "Upper bound on accuracy: an ideal Bayesian observer who "
                                       "knows the form of every effect and the bench");
  command->add_option("--benches", options->n_benches, "Number of benches, with 22 sensors each")
      ->check(positive_number())
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Seed of all random draws")->capture_default_str();
  auto* further = command->add_flag("--further", options->run.further,
                                    "Where several answers remain, adds each further experiment");
  command
      ->add_flag("--life", options->life,
                 "Bounds for 'trial make --life', for each set of records and each distance (21 "
                 "benches have all pairs of both); not with --further. A form error of the "
                 "simulation is not bounded: the observer knows the sensor as designed")
      ->excludes(further);
  command
      ->add_option("--asked", options->asked,
                   "Relative frequencies of sensors with 0, 1, 2 and 3 true effects")
      ->check(CLI::Range(0., 1e6))
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->footer("Example:\n  vibrissa trial observe --benches 5 --further");
  command->callback([options] { observe(*options); });
}

}  // namespace

void add_trial_command(CLI::App& app) {
  const auto options = std::make_shared<TrialCommand>();
  auto* command = app.add_subcommand(
      "trial",
      "Blind trials: measures how often diagnoses are right, on sensors whose effect is encrypted");
  command->require_subcommand(1);
  add_make(*command, options);
  add_run(*command, options);
  add_score(*command, options);
  add_observe(*command, options);
  command->footer(
      "Example:\n  vibrissa trial make --cases 40 --seed 5 --out trial5\n"
      "  mpirun -np 2 vibrissa trial run trial5 --threads 1\n  vibrissa trial score trial5\n"
      "  vibrissa trial observe --life");
}

}  // namespace vibrissa::apps
