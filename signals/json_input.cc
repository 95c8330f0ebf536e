#include "signals/json_input.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "signals/error.h"

namespace vibrissa::signals {

nlohmann::json read_json(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw UserError(file.string() + ": cannot be opened for reading");
  try {
    return nlohmann::json::parse(stream);
  } catch (const nlohmann::json::exception& error) {
    throw UserError(file.string() + ": is no valid JSON: " + error.what());
  }
}

}  // namespace vibrissa::signals
