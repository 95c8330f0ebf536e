#pragma once

#include <filesystem>
#include <string>

namespace vibrissa::report {

/// Throws UserError unless name is a plain file stem: letters, digits, '_', '-' and '.', not
/// starting with a dot, not ending in ".scene". The message begins with kind ("figure").
void check_file_name(const std::string& kind, const std::string& name);

/// Makes the folder and its parents unless they are there. Throws UserError with the reason.
void make_folder(const std::filesystem::path& folder);

}  // namespace vibrissa::report
