#pragma once

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "signals/files/record_io.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis::test {

/// Writes the records of a rig and their dataset.json into a folder, which is made.
inline void write_rig_dataset(const std::filesystem::path& folder, const OneModeRig& rig,
                              const RigDatasetOptions& options) {
  std::filesystem::create_directories(folder);
  nlohmann::json records = nlohmann::json::array();
  for (const signals::DatasetRecord& entry : rig_dataset(rig, options).records) {
    signals::write_record(folder / (entry.name + ".csv"), entry.record);
    nlohmann::json listed{{"file", entry.name + ".csv"},
                          {"excitation", to_string(entry.excitation)}};
    if (entry.period_samples > 0) listed["period_samples"] = entry.period_samples;
    if (entry.split == signals::Split::held_out) listed["split"] = "held_out";
    records.push_back(listed);
  }
  std::ofstream(folder / "dataset.json")
      << nlohmann::json{{"schema", "vibrissa-dataset-1"}, {"records", records}}.dump(1);
}

/// sim/: the rig as designed, without noise. real/: the same 4 ms late, with noise.
inline void write_late_rig(const std::filesystem::path& folder) {
  OneModeRig late = noisy_rig();
  late.delay_s = 0.004;
  write_rig_dataset(folder / "sim", OneModeRig{}, {.wind = true});
  write_rig_dataset(folder / "real", late, {.wind = true});
}

}  // namespace vibrissa::diagnosis::test
