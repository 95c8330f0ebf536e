#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace vibrissa::signals {

/// Largest ratio of unpacked to packed size that is accepted: the bound of deflate is 1032.
inline constexpr std::size_t largest_expansion = 1100;

/// The whole file. Throws UserError when it cannot be read.
std::string read_bytes(const std::filesystem::path& file);

/// Replaces the file by these bytes, as signals::write_file does.
void write_bytes(const std::filesystem::path& file, const std::string& bytes);

}  // namespace vibrissa::signals
