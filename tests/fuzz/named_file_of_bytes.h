#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace vibrissa::fuzz {

/// A file with the fuzzer's bytes, for readers that go by the end of its name.
class NamedFileOfBytes {
 public:
  NamedFileOfBytes(const std::uint8_t* data, std::size_t size, const std::string& end)
      : path_(std::filesystem::temp_directory_path() /
              ("vibrissa-fuzz-" + std::to_string(::getpid()) + end)) {
    std::ofstream(path_, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  }
  ~NamedFileOfBytes() { std::filesystem::remove(path_); }
  NamedFileOfBytes(const NamedFileOfBytes&) = delete;
  NamedFileOfBytes& operator=(const NamedFileOfBytes&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace vibrissa::fuzz
