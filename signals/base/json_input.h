#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace vibrissa::signals {

/// Reads a JSON file. Throws UserError with the file when it cannot be opened, is not valid JSON
/// (then with line and column) or is nested more than 64 levels deep, which could exhaust the
/// stack. Proven by tests/signals/base/json_input_test.cc.
nlohmann::json read_json(const std::filesystem::path& file);

}  // namespace vibrissa::signals
