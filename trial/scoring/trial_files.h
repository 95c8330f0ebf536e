#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vibrissa::trial {

/// One sensor of a trial: caseNNNNN/real holds its records, further/EXPERIMENT those of further
/// experiments, answer.json the diagnosis.
struct TrialEntry {
  std::string name;
  std::vector<std::string> left_out;  // effects that are removed from the catalogue
};

/// trial.json: the information that is public before the labels are opened.
struct TrialIndex {
  std::filesystem::path folder;
  std::uint64_t seed = 0;
  std::vector<TrialEntry> cases;
  std::vector<std::string> further_experiments;
  std::string commitment, sealed_labels;

  std::filesystem::path answer_file(const TrialEntry& entry) const {
    return folder / entry.name / "answer.json";
  }
};

/// Throws UserError with the file and the entry that is missing or of the wrong kind.
TrialIndex read_trial(const std::filesystem::path& folder);

/// The labels by name of case. Throws UserError when the key is missing, or when the labels do not
/// match the trial's commitment.
nlohmann::json open_labels(const TrialIndex& trial, const std::filesystem::path& key_file);

}  // namespace vibrissa::trial
