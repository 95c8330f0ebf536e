#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace vibrissa::fem {

inline std::string content(const std::filesystem::path& file) {
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  return bytes.str();
}

}  // namespace vibrissa::fem
