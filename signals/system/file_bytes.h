#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace vibrissa::signals {

/// What a packed byte unpacks to at most: deflate's bound, 1032, with room.
inline constexpr std::size_t most_swollen = 1100;

/// The whole file. Throws UserError when it cannot be read.
std::string read_bytes(const std::filesystem::path& file);

/// Replaces the file by these bytes, as signals::write_file does.
void write_bytes(const std::filesystem::path& file, const std::string& bytes);

}  // namespace vibrissa::signals
