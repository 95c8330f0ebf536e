#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace vibrissa::signals {

/// Throws UserError with the file when it cannot be opened or is no JSON.
nlohmann::json read_json(const std::filesystem::path& file);

}  // namespace vibrissa::signals
