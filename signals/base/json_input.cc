#include "signals/base/json_input.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "signals/base/error.h"

namespace vibrissa::signals {

namespace {

constexpr int deepest = 64;

// The message without the prefix of the library: "[json.exception.parse_error.101] ".
std::string reason_of(const nlohmann::json::exception& error) {
  const std::string what = error.what();
  const auto end = what.find("] ");
  return end == std::string::npos ? what : what.substr(end + 2);
}

}  // namespace

nlohmann::json read_json(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file))
    throw UserError(file.string() + ": this is a folder, not a JSON file");
  std::ifstream stream(file);
  if (!stream) throw UserError(file.string() + ": cannot be opened for reading");
  const auto is_shallow = [&](const int depth, nlohmann::json::parse_event_t, nlohmann::json&) {
    if (depth > deepest)
      throw UserError(
          file.string() + ": is nested deeper than " + std::to_string(deepest) +
          " levels, more than any file of this program; check that this is the right file");
    return true;
  };
  try {
    return nlohmann::json::parse(stream, is_shallow);
  } catch (const nlohmann::json::exception& error) {
    throw UserError(file.string() + ": is not valid JSON: " + reason_of(error));
  }
}

}  // namespace vibrissa::signals
