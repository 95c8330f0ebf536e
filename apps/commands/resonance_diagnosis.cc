#include "apps/commands/resonance_diagnosis.h"

#include <array>
#include <iostream>
#include <nlohmann/json.hpp>

#include "diagnosis/resonances/resonance_gap.h"
#include "report/files/run_folder.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "views/records/diagnosis_page.h"

namespace vibrissa::apps {
namespace {

/// "SIMULATED:MEASURED".
std::array<double, 2> simulated_and_measured(const std::string& option, const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon != std::string::npos) {
    const auto simulated = signals::to_number(text.substr(0, colon));
    const auto measured = signals::to_number(text.substr(colon + 1));
    if (simulated && measured) return {*simulated, *measured};
  }
  throw signals::UserError(option + " '" + text +
                           "' is not SIMULATED:MEASURED: give two numbers with a colon between");
}

void check(const ResonanceInput& figures) {
  if (figures.example && (figures.resonance || figures.damping))
    throw signals::UserError(
        "--example has its own resonances: leave out --resonance and --damping, or --example");
  if (figures.damping && !figures.resonance)
    throw signals::UserError("--damping needs --resonance SIMULATED_HZ:MEASURED_HZ beside it");
  if (figures.example && *figures.example != "paper-gap")
    throw signals::UserError(signals::unknown_name("example", *figures.example, {"paper-gap"}));
}

diagnosis::ResonanceExample read(const ResonanceInput& figures) {
  if (figures.example) return diagnosis::paper_gap();
  diagnosis::ResonanceExample given;
  const auto hz = simulated_and_measured("--resonance", *figures.resonance);
  given.simulated.frequency_hz = hz[0];
  given.measured.frequency_hz = hz[1];
  if (figures.damping) {
    const auto ratios = simulated_and_measured("--damping", *figures.damping);
    given.simulated.damping_ratio = ratios[0];
    given.measured.damping_ratio = ratios[1];
  }
  return given;
}

}  // namespace

void ResonanceInput::add_to(CLI::App& command) {
  command.add_option("--resonance", resonance,
                     "SIMULATED_HZ:MEASURED_HZ: the first resonances, in place of records");
  command.add_option("--damping", damping,
                     "SIMULATED:MEASURED: the damping ratios that belong to --resonance");
  command.add_option(
      "--example", example,
      "paper-gap: the two resonances of the reference study, in place of --resonance");
}

void diagnose_resonances(const ResonanceInput& figures, const NominalInput& simulation,
                         const CommonOptions& common,
                         const std::optional<std::filesystem::path>& folder) {
  check(figures);
  diagnosis::ResonanceExample given = read(figures);
  if (simulation.model)
    given.model = diagnosis::resonance_model_from(simulation.read_model(common.is_talkative()),
                                                  given.simulated.frequency_hz);
  const diagnosis::ResonanceDiagnosis diagnosis =
      diagnosis::explain_resonance_gap(given.simulated, given.measured, given.model);
  const std::string document = diagnosis::resonance_gap_json(diagnosis).dump(2) + "\n";
  const std::string text = diagnosis::resonance_gap_text(diagnosis);
  std::cout << (common.json ? document : text) << std::flush;
  if (!folder) return;
  const auto results =
      report::RunFolder::given_or_free(folder, std::filesystem::path("results/diagnosis"));
  results.write_run({.command_line = given_command_line()});
  results.write_text("resonance_gap.json", document);
  results.write_text("verdict.txt", text);
  report::write_page(results.path(), views::resonance_gap_page(diagnosis));
}

}  // namespace vibrissa::apps
