#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace vibrissa::signals {

/// Bytes of a file by their position, without keeping them in memory. The bytes of a pipe, which
/// cannot be read twice, are kept. Throws UserError when the file cannot be read.
class FileBytes {
 public:
  explicit FileBytes(const std::filesystem::path& file);
  /// Bytes that are in memory already; the file only names them.
  FileBytes(const std::filesystem::path& file, std::string bytes);
  ~FileBytes();
  FileBytes(FileBytes&& other) noexcept;
  FileBytes(const FileBytes&) = delete;

  /// Fills the buffer from this position on; reads fewer bytes only at the end of the file.
  std::size_t read(std::size_t at, char* to, std::size_t n_bytes) const;
  /// When the file was opened.
  std::size_t size() const { return size_; }

 private:
  std::string name_;
  int descriptor_ = -1;
  std::size_t size_ = 0;
  std::string held_;  // bytes of a pipe
};

/// Reads the lines of the bytes [from, to). The buffer has the length of a block, or of the longest
/// line. Proven by tests/signals/formats/text_file_test.cc.
class LineReader {
 public:
  LineReader(const FileBytes& bytes, std::size_t from, std::size_t to);

  /// Gives the next line without its '\n', valid until the next call; returns false after the last
  /// line. Throws UserError for a line of more than longest_line bytes.
  bool next(std::string_view& line);
  /// Position of the next line.
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
