#pragma once

#include <filesystem>
#include <string>

namespace vibrissa::report {

/// Throws UserError unless name is a plain file stem: letters, digits, '_', '-' and '.', not
/// starting with a dot, not ending in ".scene". The message begins with kind ("figure").
void check_file_name(const std::string& kind, const std::string& name);

/// Creates the folder and its parents if they do not exist. Throws UserError with the reason.
void make_folder(const std::filesystem::path& folder);

}  // namespace vibrissa::report
