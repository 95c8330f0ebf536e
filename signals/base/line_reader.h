#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace vibrissa::signals {

/// Bytes of a file by their place, without holding them: of what cannot be read twice (a pipe) all
/// are held. Throws UserError when the file cannot be read.
class FileBytes {
 public:
  explicit FileBytes(const std::filesystem::path& file);
  ~FileBytes();
  FileBytes(FileBytes&& other) noexcept;
  FileBytes(const FileBytes&) = delete;

  /// Fills the buffer from this place on; fewer bytes only at the file's end.
  std::size_t read(std::size_t at, char* to, std::size_t n_bytes) const;

 private:
  std::string name_;
  int descriptor_ = -1;
  std::string held_;  // of a pipe
};

/// Goes through the lines of [from, to) in a buffer that is as long as a block, or the longest
/// line. Proven by tests/signals/formats/csv_file_test.cc.
class LineReader {
 public:
  LineReader(const FileBytes& bytes, std::size_t from, std::size_t to);

  /// The next line without its '\n', valid until the next call; false behind the last one. Throws
  /// UserError for a line of more than longest_line bytes.
  bool next(std::string_view& line);
  /// Where the next line begins.
  std::size_t position() const { return buffer_at_ + used_; }

  static constexpr std::size_t longest_line = std::size_t{1} << 24;

 private:
  bool read_more();

  const FileBytes& bytes_;
  std::size_t end_;
  std::size_t buffer_at_;  // place in the file of the buffer's first byte
  std::size_t used_ = 0;
  std::string buffer_;
};

}  // namespace vibrissa::signals
