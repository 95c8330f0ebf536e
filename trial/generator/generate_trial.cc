// Writes a blind trial: generate_trial SEED FIRST COUNT FOLDER [finite-strain|life]. The records
// and the encrypted labels go to FOLDER, the key to FOLDER.key. The last line of the output is the
// commitment (hash) of the labels.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fem/linalg/solver_session.h"
#include "fem/sensor/sensor.h"
#include "signals/base/error.h"
#include "signals/files/record_io.h"
#include "signals/system/kept_memory.h"
#include "signals/system/output_file.h"
#include "signals/system/sealed_file.h"
#include "trial/generator/calibration_draw.h"
#include "trial/generator/circumstance_draw.h"
#include "trial/generator/gap_share.h"
#include "trial/generator/record_set.h"
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
  const std::vector<std::optional<double>> shares = trial::gap_shares(trial_case);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const trial::CaseEffect& effect = trial_case.effects[i];
    effects.push_back({{"id", effect.id}, {"size", effect.size}, {"limit", effect.limit}});
    if (shares[i]) effects.back()["gap_share"] = *shares[i];
  }
  return {{"class", to_string(trial_case.kind)}, {"effects", effects}, {"seed", trial_case.seed}};
}

json names_of(const std::vector<trial::FurtherExperiment>& experiments) {
  json out = json::array();
  for (const trial::FurtherExperiment& experiment : experiments) out.push_back(experiment.name);
  return out;
}

struct Options {
  std::uint64_t seed = 1;
  std::size_t first = 0, count = 0;
  fs::path folder;
  bool life = false;
  trial::Physics physics = trial::Physics::modes;
};

/// The design of the simulation as a case file; all else has the defaults of the case files.
void write_model(const fs::path& file) {
  const fem::SensorParameters design = trial::sensor_parameters({});
  signals::write_file(file, [&](std::ostream& out) {
    out << "# The simulated sensor of this trial.\n"
        << "subsection Geometry\n  set Fin = cross\n  set Free length = "
        << design.geometry.free_length
        << "\nend\nsubsection Model\n  set Mesh resolution = " << design.model.mesh_resolution
        << "\n  set Number of modes = " << design.model.n_modes << "\nend\n";
  });
}

/// The simulation of a case of life: the common one, or one of its own. Returns its path in the
/// folder of the trial.
std::string write_simulation(const fs::path& making, const std::string& name,
                             const trial::TrialCase& trial_case, const trial::SimulationForm& form,
                             std::uint64_t seed) {
  const trial::Circumstances& circumstances = trial_case.circumstances;
  if (circumstances.way_in == trial::WayIn::model) return "sim.prm";
  if (!trial::has_own_simulation(circumstances)) return "sim";
  const signals::Dataset records = trial::simulated_records(seed, form, circumstances.set);
  if (circumstances.set == trial::RecordSet::two_files) {
    fs::create_directories(making / name);
    signals::write_record(making / name / "sim.csv", records.records.front().record);
    return name + "/sim.csv";
  }
  write_dataset(making / name / "sim", records);
  return name + "/sim";
}

std::string write_bench(const fs::path& making, const std::string& name,
                        const trial::TrialCase& trial_case) {
  const signals::Dataset records = trial::records_of(trial_case);
  if (trial_case.circumstances.set == trial::RecordSet::two_files) {
    fs::create_directories(making / name);
    signals::write_record(making / name / "real.csv", records.records.front().record);
    return name + "/real.csv";
  }
  write_dataset(making / name / "real", records);
  return name + "/real";
}

/// Adds what only a trial of life has to the public entry of a case and to its label.
void add_life(json& entry, json& label, const trial::TrialCase& trial_case,
              const trial::SimulationForm& form) {
  const trial::Circumstances& circumstances = trial_case.circumstances;
  entry["set"] = to_string(circumstances.set);
  entry["further_experiments"] = names_of(trial::further_experiments_of(trial_case));
  entry["simulation_accuracy"] = stated_accuracy(circumstances.form_error);
  label["circumstances"] = to_json(circumstances);
  label["calibrations"] = trial::calibrations_of(trial_case.plain);
  label["simulation"] = to_json(form);
}

struct WrittenCase {
  json entry, label;
};

WrittenCase write_case(const Options& options, const fs::path& making, const std::size_t number) {
  const trial::Circumstances circumstances =
      options.life ? trial::draw_circumstances(options.seed, number, trial::class_of(number))
                   : trial::Circumstances{};
  const trial::TrialCase trial_case =
      trial::draw_case(options.seed, number, options.physics, circumstances,
                       stated_accuracy(circumstances.form_error));
  const std::string name = case_name(number);
  WrittenCase out{.entry = {{"name", name}, {"left_out", trial_case.left_out}},
                  .label = label_of(trial_case)};
  const std::string real = write_bench(making, name, trial_case);
  for (const auto& [experiment, records] : trial::further_records_of(trial_case))
    write_dataset(making / name / "further" / experiment, records);
  if (!options.life) return out;
  const trial::SimulationForm form = trial::form_of(trial_case);
  out.entry["real"] = real;
  out.entry["simulation"] = write_simulation(making, name, trial_case, form, options.seed);
  add_life(out.entry, out.label, trial_case, form);
  return out;
}

void generate(const Options& options) {
  const fs::path& folder = options.folder;
  if (fs::exists(folder))
    throw signals::UserError(folder.string() + " exists already; give another folder");
  const fs::path making = folder.string() + ".making", key_file = folder.string() + ".key";
  fs::remove_all(making);
  write_dataset(making / "sim", trial::simulated_records(options.seed, options.physics));
  if (options.life) write_model(making / "sim.prm");
  json labels = json::object(), cases = json::array();
  for (std::size_t i = options.first; i < options.first + options.count; ++i) {
    const WrittenCase written = write_case(options, making, i);
    labels[written.entry["name"].get<std::string>()] = written.label;
    cases.push_back(written.entry);
  }
  const signals::Seal seal = signals::seal(labels.dump(1));
  const bool is_solid = options.physics == trial::Physics::finite_strain;
  write_json(
      making / "trial.json",
      {{"schema", options.life ? "vibrissa-trial-2" : "vibrissa-trial-1"},
       {"seed", options.seed},
       {"first", options.first},
       {"cases", cases},
       {"further_experiments", is_solid ? json::array() : names_of(trial::further_experiments())},
       {"labels_commitment_sha256", seal.commitment},
       {"labels_sealed", seal.cipher}});
  signals::write_file(key_file, [&](std::ostream& out) { out << seal.key << "\n"; });
  fs::permissions(key_file, fs::perms::owner_read | fs::perms::owner_write);
  fs::rename(making, folder);
  std::cout << "labels are bound to " << seal.commitment << "\n";
}

Options options_of(const std::vector<std::string>& words) {
  const std::string kind = words.size() == 5 ? words[4] : "";
  if (words.size() < 4 || words.size() > 5 ||
      (words.size() == 5 && kind != "finite-strain" && kind != "life"))
    throw signals::UserError("usage: generate_trial SEED FIRST COUNT FOLDER [finite-strain|life]");
  return {
      .seed = std::stoull(words[0]),
      .first = std::stoull(words[1]),
      .count = std::stoull(words[2]),
      .folder = words[3],
      .life = kind == "life",
      .physics = kind == "finite-strain" ? trial::Physics::finite_strain : trial::Physics::modes};
}

}  // namespace

int main(int argc, char** argv) try {
  const Options options = options_of({argv + 1, argv + argc});
  signals::keep_freed_memory();
  const fem::SolverSession session;
  generate(options);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "generate_trial: " << error.what() << "\n";
  return 2;
}
