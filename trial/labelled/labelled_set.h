#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "diagnosis/model/hypothesis.h"
#include "signals/base/json_input.h"
#include "signals/system/kept_memory.h"

/// A folder with sim/, caseNNN/real/ and labels.json.
namespace vibrissa::benchmarks {

/// labels.json of the set; it is read only after the diagnosis.
inline nlohmann::json label_of(const std::filesystem::path& set, const std::string& name) {
  return signals::read_json(set / "labels.json")[name];
}

inline std::string sorted_name(const std::string& name) {
  return diagnosis::joined_name(diagnosis::effect_ids(name));
}

/// The name without calibration effects, used to score sensors with building tolerances.
inline std::string without_calibrations(const std::string& name) {
  const std::vector<std::string>& calibrations = diagnosis::nuisance_ids();
  std::vector<std::string> ids;
  for (const std::string& id : diagnosis::effect_ids(name))
    if (std::find(calibrations.begin(), calibrations.end(), id) == calibrations.end())
      ids.push_back(id);
  return diagnosis::joined_name(ids);
}

/// Names of the cases, in order.
inline std::vector<std::string> cases_of(const std::filesystem::path& set) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(set))
    if (std::filesystem::exists(entry.path() / "real"))
      names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// main() of a scoring program: a UserError becomes a message and exit status 2.
inline int guarded(const std::function<int()>& run) {
  signals::keep_freed_memory();  // as the program does
  try {
    return run();
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
}

}  // namespace vibrissa::benchmarks
