#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "signals/base/error.h"
#include "signals/base/json_input.h"

namespace vibrissa::report {

using signals::read_json;

/// Writes JSON with two spaces of indentation and each list of numbers on one line. The file is
/// complete or does not exist.
void write_json(const std::filesystem::path& file, const nlohmann::json& json);

/// The number; null for nothing and for a number that is not finite, which JSON cannot represent.
nlohmann::json json_or_null(const std::optional<double>& number);

/// json[key] as a T. Throws UserError that names the key when it is missing or of another type.
template <typename T>
T required(const nlohmann::json& json, const std::string& key) {
  const auto entry = json.is_object() ? json.find(key) : json.end();
  if (entry == json.end()) throw signals::UserError("'" + key + "' is missing");
  try {
    return entry->template get<T>();
  } catch (const nlohmann::json::exception&) {
    throw signals::UserError("'" + key + "' has the wrong type: " + entry->dump().substr(0, 40));
  }
}

/// Like required(), with a default for a missing key.
template <typename T>
T given_or(const nlohmann::json& json, const std::string& key, const T& otherwise) {
  return json.is_object() && json.contains(key) ? required<T>(json, key) : otherwise;
}

}  // namespace vibrissa::report
