// Writes a blind trial: generate_trial SEED FIRST COUNT FOLDER [finite-strain]. The records and the
// encrypted labels go to FOLDER, the key to FOLDER.key. The last line of the output is the
// commitment (hash) of the labels.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "fem/linalg/solver_session.h"
#include "signals/base/error.h"
#include "signals/files/record_io.h"
#include "signals/system/kept_memory.h"
#include "signals/system/output_file.h"
#include "signals/system/sealed_file.h"
#include "trial/generator/trial_case.h"

namespace {

namespace fs = std::filesystem;
using namespace vibrissa;
using nlohmann::json;

void write_json(const fs::path& file, const json& document) {
  signals::write_file(file, [&](std::ostream& out) { out << document.dump(1) << "\n"; });
}

void write_dataset(const fs::path& folder, const signals::Dataset& dataset) {
  fs::create_directories(folder);
  json records = json::array();
  for (const signals::DatasetRecord& entry : dataset.records) {
    signals::write_record(folder / (entry.name + ".csv"), entry.record);
    records.push_back({{"file", entry.name + ".csv"},
                       {"excitation", to_string(entry.excitation)},
                       {"period_samples", entry.period_samples},
                       {"split", entry.split == signals::Split::fit ? "fit" : "held_out"}});
  }
  write_json(folder / "dataset.json", {{"schema", "vibrissa-dataset-1"},
                                       {"sampling_rate_hz", trial::rate_hz},
                                       {"records", records}});
}

std::string case_name(std::size_t number) {
  char name[32];
  std::snprintf(name, sizeof name, "case%05zu", number);
  return name;
}

json label_of(const trial::TrialCase& trial_case) {
  json effects = json::array();
  for (const trial::CaseEffect& effect : trial_case.effects)
    effects.push_back({{"id", effect.id}, {"size", effect.size}, {"limit", effect.limit}});
  return {{"class", to_string(trial_case.kind)}, {"effects", effects}, {"seed", trial_case.seed}};
}

void generate(std::uint64_t seed, std::size_t first, std::size_t count, const fs::path& folder,
              const trial::Physics physics) {
  if (fs::exists(folder))
    throw signals::UserError(folder.string() + " exists already; give another folder");
  const fs::path making = folder.string() + ".making", key_file = folder.string() + ".key";
  fs::remove_all(making);
  write_dataset(making / "sim", trial::simulated_records(seed, physics));
  json labels = json::object(), cases = json::array(), further = json::array();
  for (const trial::FurtherExperiment& experiment : trial::further_experiments(physics))
    further.push_back(experiment.name);
  for (std::size_t i = first; i < first + count; ++i) {
    const trial::TrialCase trial_case = trial::draw_case(seed, i, physics);
    const std::string name = case_name(i);
    write_dataset(making / name / "real", trial::records_of(trial_case));
    for (const auto& [experiment, records] : trial::further_records_of(trial_case))
      write_dataset(making / name / "further" / experiment, records);
    cases.push_back({{"name", name}, {"left_out", trial_case.left_out}});
    labels[name] = label_of(trial_case);
  }
  const signals::Seal seal = signals::seal(labels.dump(1));
  write_json(making / "trial.json", {{"schema", "vibrissa-trial-1"},
                                     {"seed", seed},
                                     {"first", first},
                                     {"cases", cases},
                                     {"further_experiments", further},
                                     {"labels_commitment_sha256", seal.commitment},
                                     {"labels_sealed", seal.cipher}});
  signals::write_file(key_file, [&](std::ostream& out) { out << seal.key << "\n"; });
  fs::permissions(key_file, fs::perms::owner_read | fs::perms::owner_write);
  fs::rename(making, folder);
  std::cout << "labels are bound to " << seal.commitment << "\n";
}

}  // namespace

int main(int argc, char** argv) try {
  const bool finite_strain = argc == 6 && std::string(argv[5]) == "finite-strain";
  if (argc != 5 && !finite_strain) {
    std::cerr << "usage: generate_trial SEED FIRST COUNT FOLDER [finite-strain]\n";
    return 2;
  }
  signals::keep_freed_memory();
  const fem::SolverSession session;
  generate(std::stoull(argv[1]), std::stoull(argv[2]), std::stoull(argv[3]), argv[4],
           finite_strain ? trial::Physics::finite_strain : trial::Physics::modes);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "generate_trial: " << error.what() << "\n";
  return 2;
}
