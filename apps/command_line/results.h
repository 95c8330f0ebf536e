#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace vibrissa::apps {

/// results/NAME, or results/NAME-2, ... where that is taken: the folder of a command that was not
/// told another one.
std::filesystem::path free_results_folder(const std::string& name);

/// The file that was asked for, or FILE in a free results folder of that name, which is made.
/// Proven by tests/apps/results_test.cc.
std::string given_or_result(const std::optional<std::string>& given, const std::string& name,
                            const std::string& file);

}  // namespace vibrissa::apps
