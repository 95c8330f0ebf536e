#include "signals/record/bench_setup.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::signals {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& where, const std::string& key,
                         const std::string& rule) {
  throw UserError(where + "/" + key + ": " + rule);
}

double number_of(const json& value, const std::string& where, const std::string& key) {
  if (!value.is_number()) refuse(where, key, "must be a number");
  return value.get<double>();
}

double size_of(const json& value, const std::string& where, const std::string& key) {
  const double size = number_of(value, where, key);
  if (size < 0.) refuse(where, key, "must not be negative");
  return size;
}

bool truth_of(const json& value, const std::string& where, const std::string& key) {
  if (!value.is_boolean()) refuse(where, key, "must be true or false");
  return value.get<bool>();
}

Stage stage_of(const json& value, const std::string& where) {
  const std::string word = value.is_string() ? value.get<std::string>() : value.dump();
  if (word == "free") return Stage::free;
  if (word == "clamped") return Stage::clamped;
  refuse(where, "stage", unknown_name("stage", word, {"free", "clamped"}));
}

}  // namespace

BenchSetup read_bench_setup(const json& entry, const std::string& where) {
  if (!entry.is_object()) throw UserError(where + ": must be an object");
  BenchSetup setup;
  for (const auto& [key, value] : entry.items()) {
    if (key == "added_mass_kg")
      setup.added_mass_kg = size_of(value, where, key);
    else if (key == "added_mass_height_m")
      setup.added_mass_height_m = size_of(value, where, key);
    else if (key == "tilt_deg")
      setup.tilt_deg = number_of(value, where, key);
    else if (key == "rotation_deg")
      setup.rotation_deg = number_of(value, where, key);
    else if (key == "stage")
      setup.stage = stage_of(value, where);
    else if (key == "coil_driven")
      setup.coil_driven = truth_of(value, where, key);
    else if (key == "magnet")
      setup.magnet = truth_of(value, where, key);
    else
      throw UserError(where + ": " +
                      unknown_name("entry", key,
                                   {"added_mass_kg", "added_mass_height_m", "tilt_deg",
                                    "rotation_deg", "stage", "coil_driven", "magnet"}));
  }
  return setup;
}

std::string to_string(const BenchSetup& setup) {
  const BenchSetup usual;
  std::vector<std::string> parts;
  if (setup.added_mass_kg != usual.added_mass_kg)
    parts.push_back(to_text(1e3 * setup.added_mass_kg) + " g added at " +
                    to_text(1e3 * setup.added_mass_height_m) + " mm");
  if (setup.tilt_deg != usual.tilt_deg)
    parts.push_back("tilted by " + to_text(setup.tilt_deg) + " degrees");
  if (setup.rotation_deg != usual.rotation_deg)
    parts.push_back("turned by " + to_text(setup.rotation_deg) + " degrees");
  if (setup.stage != usual.stage) parts.push_back("stage clamped");
  if (setup.coil_driven != usual.coil_driven) parts.push_back("coil not driven");
  if (setup.magnet != usual.magnet) parts.push_back("magnet removed");
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

}  // namespace vibrissa::signals
