#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace vibrissa::signals {

/// Throws UserError with the file when it cannot be opened, is no JSON (then with line and column)
/// or is nested beyond anything of ours, which would exhaust the stack of whoever walks it. Proven
/// by tests/signals/base/json_input_test.cc.
nlohmann::json read_json(const std::filesystem::path& file);

}  // namespace vibrissa::signals
