#include "trial/scoring/trial_files.h"

#include <fstream>

#include "signals/base/error.h"
#include "signals/base/json_input.h"
#include "signals/system/sealed_file.h"

namespace vibrissa::trial {
namespace fs = std::filesystem;

namespace {

constexpr const char* of_complete_records = "vibrissa-trial-1";
constexpr const char* of_circumstances = "vibrissa-trial-2";

void check_schema(const std::string& schema, const fs::path& file) {
  if (schema != of_complete_records && schema != of_circumstances)
    throw signals::UserError(file.string() + ": /schema: \"" + schema + "\" is neither \"" +
                             of_complete_records + "\" nor \"" + of_circumstances +
                             "\"; make the trial again with: vibrissa trial make");
}

/// What an entry of version 1 does not say is the same for all its cases.
TrialEntry entry_from(const nlohmann::json& entry, const fs::path& folder,
                      const std::vector<std::string>& further_experiments) {
  TrialEntry out{.name = entry.at("name").get<std::string>(),
                 .left_out = entry.at("left_out").get<std::vector<std::string>>()};
  out.real = folder / entry.value("real", out.name + "/real");
  out.simulation = folder / entry.value("simulation", "sim");
  if (entry.contains("simulation_accuracy"))
    out.simulation_accuracy = entry.at("simulation_accuracy").get<double>();
  out.further_experiments = entry.value("further_experiments", further_experiments);
  return out;
}

}  // namespace

TrialIndex read_trial(const fs::path& folder) {
  const fs::path file = folder / "trial.json";
  if (!fs::exists(file))
    throw signals::UserError(folder.string() +
                             ": holds no trial.json; make one with: vibrissa trial make --out " +
                             folder.string());
  const nlohmann::json document = signals::read_json(file);
  try {
    check_schema(document.at("schema").get<std::string>(), file);
    TrialIndex out{
        .folder = folder,
        .seed = document.at("seed").get<std::uint64_t>(),
        .cases = {},
        .further_experiments = document.at("further_experiments").get<std::vector<std::string>>(),
        .commitment = document.at("labels_commitment_sha256").get<std::string>(),
        .sealed_labels = document.at("labels_sealed").get<std::string>()};
    for (const auto& entry : document.at("cases"))
      out.cases.push_back(entry_from(entry, folder, out.further_experiments));
    return out;
  } catch (const nlohmann::json::exception& error) {
    throw signals::UserError(file.string() + ": " + error.what());
  }
}

nlohmann::json open_labels(const TrialIndex& trial, const fs::path& key_file) {
  std::string key;
  if (!(std::ifstream(key_file) >> key))
    throw signals::UserError(key_file.string() +
                             ": the key of the labels is missing; give it with --key FILE");
  try {
    return nlohmann::json::parse(signals::unseal(
        {.cipher = trial.sealed_labels, .key = key, .commitment = trial.commitment}));
  } catch (const signals::UserError& error) {
    throw signals::UserError(key_file.string() + ": " + error.what());
  }
}

}  // namespace vibrissa::trial
