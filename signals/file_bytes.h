#pragma once

#include <filesystem>
#include <string>

namespace vibrissa::signals {

/// The whole file. Throws UserError when it cannot be read.
std::string read_bytes(const std::filesystem::path& file);

/// Replaces the file by these bytes, as signals::write_file does.
void write_bytes(const std::filesystem::path& file, const std::string& bytes);

}  // namespace vibrissa::signals
