#include "trial/scoring/trial_files.h"

#include <fstream>

#include "signals/base/error.h"
#include "signals/base/json_input.h"
#include "signals/system/sealed_file.h"

namespace vibrissa::trial {
namespace fs = std::filesystem;

TrialIndex read_trial(const fs::path& folder) {
  const fs::path file = folder / "trial.json";
  if (!fs::exists(file))
    throw signals::UserError(folder.string() +
                             ": holds no trial.json; make one with: vibrissa trial make --out " +
                             folder.string());
  const nlohmann::json document = signals::read_json(file);
  try {
    if (document.at("schema") != "vibrissa-trial-1")
      throw signals::UserError(file.string() + ": /schema: must be \"vibrissa-trial-1\"");
    TrialIndex out{
        .folder = folder,
        .seed = document.at("seed").get<std::uint64_t>(),
        .cases = {},
        .further_experiments = document.at("further_experiments").get<std::vector<std::string>>(),
        .commitment = document.at("labels_commitment_sha256").get<std::string>(),
        .sealed_labels = document.at("labels_sealed").get<std::string>()};
    for (const auto& entry : document.at("cases"))
      out.cases.push_back({entry.at("name").get<std::string>(),
                           entry.at("left_out").get<std::vector<std::string>>()});
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
