#include "signals/system/output_file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <set>
#include <streambuf>
#include <system_error>
#include <utility>
#include <vector>

#include "signals/base/error.h"

namespace vibrissa::signals {
namespace {

namespace fs = std::filesystem;

/// Whether the name is at fault, which another name would mend, rather than the disk.
bool is_about_the_name(const std::error_code& error) {
  constexpr std::array names = {std::errc::no_such_file_or_directory,
                                std::errc::not_a_directory,
                                std::errc::is_a_directory,
                                std::errc::filename_too_long,
                                std::errc::permission_denied,
                                std::errc::operation_not_permitted,
                                std::errc::read_only_file_system,
                                std::errc::too_many_symbolic_link_levels,
                                std::errc::invalid_argument};
  return std::ranges::any_of(names, [&](const std::errc name) { return error == name; });
}

[[noreturn]] void refuse(const fs::path& file, const int error) {
  refuse_path(file, "cannot be written", {error, std::generic_category()});
}

// Keeps the reason of the system when a write fails; std::ofstream does not.
class FileBuffer : public std::streambuf {
 public:
  explicit FileBuffer(const int descriptor) : descriptor_(descriptor) {
    setp(block_.data(), block_.data() + block_.size());
  }
  ~FileBuffer() override { close(); }
  FileBuffer(const FileBuffer&) = delete;
  FileBuffer& operator=(const FileBuffer&) = delete;

  int error() const { return error_; }

  void close() {
    if (descriptor_ >= 0 && ::close(descriptor_) != 0 && error_ == 0) error_ = errno;
    descriptor_ = -1;
  }

  // Some files, such as pipes and terminals, cannot be flushed to a disk and need not be.
  void flush_to_disk() {
    if (sync() == 0 && ::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS)
      error_ = errno;
  }

 protected:
  int_type overflow(const int_type c) override {
    if (sync() != 0) return traits_type::eof();
    if (!traits_type::eq_int_type(c, traits_type::eof())) sputc(traits_type::to_char_type(c));
    return traits_type::not_eof(c);
  }

  int sync() override {
    const char* from = pbase();
    while (error_ == 0 && from < pptr()) {
      const ::ssize_t n = ::write(descriptor_, from, static_cast<std::size_t>(pptr() - from));
      if (n >= 0)
        from += n;
      else if (errno != EINTR)
        error_ = errno;
    }
    setp(block_.data(), block_.data() + block_.size());
    return error_ == 0 ? 0 : -1;
  }

 private:
  int descriptor_;
  int error_ = 0;
  std::array<char, 1 << 16> block_;
};

const std::string unfinished = ".unfinished-";  // then the process and a number

// A new file in the folder of another one, removed unless it was renamed to its final name.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& beside) {
    static std::atomic<unsigned> n_made = 0;
    const std::string stem = unfinished + std::to_string(::getpid()) + "-";
    do {
      name_ = beside.parent_path() / (stem + std::to_string(n_made++));
      descriptor_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (descriptor_ < 0 && errno == EEXIST);
    if (descriptor_ < 0) refuse(beside, errno);
  }
  ~TemporaryFile() {
    if (!renamed_) ::unlink(name_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  int descriptor() const { return descriptor_; }

  void rename_to(const fs::path& file) {
    if (::rename(name_.c_str(), file.c_str()) != 0) refuse(file, errno);
    renamed_ = true;
  }

 private:
  fs::path name_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

void fill(FileBuffer& buffer, const fs::path& file,
          const std::function<void(std::ostream&)>& writer) {
  std::ostream out(&buffer);
  try {
    writer(out);
  } catch (...) {
    // Libraries that detect a bad stream do not know the reason.
    if (buffer.error() != 0) refuse(file, buffer.error());
    throw;
  }
  buffer.flush_to_disk();
  buffer.close();
  if (buffer.error() != 0) refuse(file, buffer.error());
  if (!out)
    throw InternalError(file.string() + ": cannot be written: the function that writes it failed");
}

// On a file system without permissions the default ones are used.
void copy_permissions(const fs::path& from, const int to_descriptor) {
  struct ::stat old;
  if (::stat(from.c_str(), &old) == 0) ::fchmod(to_descriptor, old.st_mode & 07777);
}

void write_in_place(const fs::path& file, const std::function<void(std::ostream&)>& writer) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) refuse(file, errno);
  FileBuffer buffer(descriptor);
  fill(buffer, file, writer);
}

}  // namespace

void refuse_path(const fs::path& path, const std::string& what, const std::error_code& error) {
  const std::string message = path.string() + ": " + what + ": " + error.message();
  if (is_about_the_name(error)) throw UserError(message);
  throw ResourceError(message);
}

void write_file(const fs::path& file, const std::function<void(std::ostream&)>& writer) {
  std::error_code no_file;
  const fs::file_status status = fs::status(file, no_file);
  if (!file.has_filename() || fs::is_directory(status))
    throw UserError(file.string() + ": cannot be written: this is a folder; name a file");
  // A name such as /dev/stdout must not be replaced by a file.
  if (fs::exists(status) && !fs::is_regular_file(status)) return write_in_place(file, writer);
  // A link stays; what it points to is replaced.
  const fs::path target = fs::exists(status) ? fs::canonical(file) : file;
  TemporaryFile temporary(target);
  FileBuffer buffer(temporary.descriptor());
  copy_permissions(target, temporary.descriptor());
  fill(buffer, file, writer);
  temporary.rename_to(target);
}

void remove_unfinished_files(const fs::path& folder) {
  std::vector<fs::path> left;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(unfinished) || !entry.is_regular_file()) continue;
    const auto process = static_cast<::pid_t>(std::atoi(name.c_str() + unfinished.size()));
    if (process > 0 && ::kill(process, 0) != 0 && errno == ESRCH) left.push_back(entry.path());
  }
  for (const fs::path& file : left) fs::remove(file);
}

namespace {

void refuse_what_is_not_empty(const fs::path& folder) {
  std::error_code error;
  const bool empty = fs::is_empty(folder, error);
  if (error) refuse_path(folder, "cannot be read", error);
  if (!empty)
    throw UserError(folder.string() +
                    ": this folder exists and is not empty; results of an earlier run are not "
                    "overwritten: name another folder, or remove this one");
}

/// Two runs that see the same empty folder must not both write into it: this process locks the
/// folder until it ends. On a file system without locks the folder is used without a lock.
void claim(const fs::path& folder) {
  static std::set<std::pair<::dev_t, ::ino_t>> ours;
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  struct ::stat status {};
  const bool is_new =
      ::fstat(descriptor, &status) == 0 && ours.insert({status.st_dev, status.st_ino}).second;
  if (is_new && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return;
  const bool is_taken = is_new && errno == EWOULDBLOCK;
  ::close(descriptor);
  if (!is_taken) return;
  ours.erase({status.st_dev, status.st_ino});
  throw UserError(folder.string() +
                  ": this folder exists and another run writes into it; name another folder");
}

}  // namespace

void make_new_folder(const fs::path& folder) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (fs::exists(status) && !fs::is_directory(status))
    throw UserError(folder.string() + ": this is a file, not a folder; name another folder");
  if (fs::is_directory(status)) refuse_what_is_not_empty(folder);
  fs::create_directories(folder, error);
  if (error) refuse_path(folder, "cannot be created", error);
  claim(folder);
  refuse_what_is_not_empty(folder);
}

fs::path free_folder_name(const fs::path& base) {
  const fs::path plain = base.has_filename() ? base : base.parent_path();
  const auto taken = [](const fs::path& path) {
    std::error_code ignored;
    return fs::exists(fs::symlink_status(path, ignored));
  };
  fs::path candidate = plain;
  for (std::size_t i = 2; taken(candidate); ++i) {
    candidate = plain;
    candidate += "-";
    candidate += std::to_string(i);
  }
  return candidate;
}

}  // namespace vibrissa::signals
