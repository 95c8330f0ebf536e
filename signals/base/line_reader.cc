#include "signals/base/line_reader.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "signals/base/error.h"

namespace vibrissa::signals {
namespace {

constexpr std::size_t block = std::size_t{1} << 17;

[[noreturn]] void refuse(const std::string& name) {
  throw UserError(name + ": cannot be read: " + std::generic_category().message(errno));
}

}  // namespace

FileBytes::FileBytes(const std::filesystem::path& file)
    : name_(file.string()), descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
  struct ::stat status;
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) refuse(name_);
  size_ = static_cast<std::size_t>(status.st_size);
  if (S_ISREG(status.st_mode) && size_ > 0) return;
  std::string part(block, '\0');
  for (;;) {
    const ::ssize_t n = ::read(descriptor_, part.data(), part.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) refuse(name_);
    if (n == 0) break;
    held_.append(part, 0, static_cast<std::size_t>(n));
  }
  ::close(std::exchange(descriptor_, -1));
  size_ = held_.size();
}

FileBytes::FileBytes(const std::filesystem::path& file, std::string bytes)
    : name_(file.string()), size_(bytes.size()), held_(std::move(bytes)) {}

FileBytes::~FileBytes() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

FileBytes::FileBytes(FileBytes&& other) noexcept
    : name_(std::move(other.name_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_),
      held_(std::move(other.held_)) {}

std::size_t FileBytes::read(const std::size_t at, char* const to, const std::size_t n_bytes) const {
  if (descriptor_ < 0) {
    const std::size_t from = std::min(at, held_.size());
    const std::size_t n = std::min(n_bytes, held_.size() - from);
    std::memcpy(to, held_.data() + from, n);
    return n;
  }
  std::size_t done = 0;
  while (done < n_bytes) {
    const ::ssize_t n =
        ::pread(descriptor_, to + done, n_bytes - done, static_cast<::off_t>(at + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) refuse(name_);
    if (n == 0) break;
    done += static_cast<std::size_t>(n);
  }
  return done;
}

LineReader::LineReader(const FileBytes& bytes, const std::size_t from, const std::size_t to)
    : bytes_(bytes), end_(std::min(to, bytes.size())), buffer_at_(from) {}

// Drops what is used and appends a block, or what is left.
bool LineReader::read_more() {
  buffer_.erase(0, used_);
  buffer_at_ += std::exchange(used_, 0);
  const std::size_t held = buffer_.size();
  const std::size_t at = std::min(buffer_at_ + held, end_);
  buffer_.resize(held + std::min(block, end_ - at));
  const std::size_t n = bytes_.read(at, buffer_.data() + held, buffer_.size() - held);
  buffer_.resize(held + n);
  return n > 0;
}

bool LineReader::next(std::string_view& line) {
  std::size_t looked_at = used_;
  for (;;) {
    const std::size_t found = buffer_.find('\n', looked_at);
    if (found != std::string::npos) {
      line = std::string_view(buffer_).substr(used_, found - used_);
      used_ = found + 1;
      return true;
    }
    const std::size_t length = buffer_.size() - used_;
    if (length > longest_line)
      throw UserError("a line is longer than " + std::to_string(longest_line >> 20) +
                      " MiB: this is not a table of numbers");
    const bool more = read_more();
    looked_at = length;
    if (more) continue;
    line = buffer_;
    used_ = buffer_.size();
    return !line.empty();
  }
}

}  // namespace vibrissa::signals
