#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace vibrissa::trial {

/// One sensor of a trial: caseNNNNN/further/EXPERIMENT holds the records of further experiments,
/// answer.json the diagnosis.
struct TrialEntry {
  std::string name;
  std::vector<std::string> left_out;               // effects that are removed from the catalogue
  std::filesystem::path real{}, simulation{};      // records; records or a case file (.prm)
  std::optional<double> simulation_accuracy{};     // as its maker states it
  std::vector<std::string> further_experiments{};  // that its bench can do
};

/// trial.json: the information that is public before the labels are opened.
struct TrialIndex {
  std::filesystem::path folder;
  std::uint64_t seed = 0;
  std::vector<TrialEntry> cases;
  std::vector<std::string> further_experiments;  // of all cases together
  std::string commitment, sealed_labels;

  std::filesystem::path answer_file(const TrialEntry& entry) const {
    return folder / entry.name / "answer.json";
  }
};

/// Reads schema "vibrissa-trial-1" (complete records, one simulation for all) and
/// "vibrissa-trial-2" (each case with its own circumstances). Throws UserError with the file and
/// the entry that is missing or of the wrong kind, and for every other schema.
TrialIndex read_trial(const std::filesystem::path& folder);

/// The labels by name of case. Throws UserError when the key is missing, or when the labels do not
/// match the trial's commitment.
nlohmann::json open_labels(const TrialIndex& trial, const std::filesystem::path& key_file);

}  // namespace vibrissa::trial
