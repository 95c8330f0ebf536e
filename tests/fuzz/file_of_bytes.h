#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace vibrissa::fuzz {

/// A file in memory with the fuzzer's bytes, for readers that take a path.
class FileOfBytes {
 public:
  FileOfBytes(const std::uint8_t* data, std::size_t size)
      : descriptor_(::memfd_create("vibrissa-fuzz", 0)) {
    if (descriptor_ < 0) std::abort();
    for (std::size_t done = 0; done < size;) {
      const ::ssize_t n = ::write(descriptor_, data + done, size - done);
      if (n <= 0) std::abort();
      done += static_cast<std::size_t>(n);
    }
  }
  explicit FileOfBytes(const std::string& text)
      : FileOfBytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()) {}
  ~FileOfBytes() { ::close(descriptor_); }
  FileOfBytes(const FileOfBytes&) = delete;
  FileOfBytes& operator=(const FileOfBytes&) = delete;

  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

}  // namespace vibrissa::fuzz
