// Preloaded (LD_PRELOAD) into a program under test. Its opens for writing, writes, renames, large
// allocations and forks are the points at which the system can fail it; they are counted. Told a
// judge, every one fails in turn, each in a child of the program; told a kind and a number, this
// one fails.
//
// FAULT_PROGRAM  name of the program that is meant; others (its children) run undisturbed
// FAULT_COMMAND  its first argument
// FAULT_WITH     a variable that must be set, if given, as DISPLAY: the child that has got one
// FAULT_FOLDER   files below it are meant; reading elsewhere is not
// FAULT_TALK     descriptors of a judge (fault_child.h)
// FAULT_EVERY    with a judge: each Nth call of a kind, beginning with half of it (default 1)
// FAULT_KIND     open | write | rename | memory | fork
// FAULT_NUMBER   1 for the first call of this kind
// FAULT_LARGE    bytes from which on an allocation counts (default 1 MiB)
// FAULT_COUNTS   file that gets "kind count" lines when the program ends

#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>

#include "tests/faults/fault_child.h"

extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t n, size_t size);
void* __libc_realloc(void* old, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
}

namespace {

enum Kind { open_kind, write_kind, rename_kind, memory_kind, fork_kind, n_kinds };
constexpr std::array<const char*, n_kinds> names{"open", "write", "rename", "memory", "fork"};
size_t large_bytes = 1 << 20;

std::array<std::atomic<long>, n_kinds> counts;
std::atomic<bool> is_active{false};
bool is_in_child = false;
int chosen_kind = -1;
long chosen_number = 0, every = 1;
char folder[PATH_MAX];
std::optional<vibrissa::faults::FaultChildren> children;

long long_of(const char* name, const long otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atol(text);
}

bool fails(const Kind kind) {
  if (!is_active) return false;
  const long number = ++counts[kind];
  if (!children) return number == chosen_number && kind == chosen_kind;
  if (number % every != every / 2 % every) return false;
  is_active = false;  // the children's own files and memory are none of the points
  const bool is_child = children->is_child(names[kind] + (" " + std::to_string(number)));
  is_active = !is_child;
  is_in_child = is_child;
  return is_child;
}

bool is_meant(const char* path) {
  return is_active && std::strncmp(path, folder, std::strlen(folder)) == 0;
}

bool is_meant(const int file) {
  if (!is_active) return false;
  char link[64], path[PATH_MAX];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  if (length <= 0) return false;
  path[length] = 0;
  return is_meant(path);
}

template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

template <typename Result>
Result failure(const int reason, const Result result) {
  errno = reason;
  return result;
}

// The loader gives a constructor what main() gets.
__attribute__((constructor)) void begin(const int n_arguments, char** arguments, char**) {
  const char* program = std::getenv("FAULT_PROGRAM");
  const char* command = std::getenv("FAULT_COMMAND");
  const char* where = std::getenv("FAULT_FOLDER");
  const char* with = std::getenv("FAULT_WITH");
  if (program == nullptr || command == nullptr || where == nullptr || n_arguments < 2 ||
      std::strcmp(program, program_invocation_short_name) != 0 ||
      std::strcmp(command, arguments[1]) != 0 || (with != nullptr && std::getenv(with) == nullptr))
    return;
  std::snprintf(folder, sizeof folder, "%s", where);
  if (const char* kind = std::getenv("FAULT_KIND"))
    for (int k = 0; k < n_kinds; ++k)
      if (std::strcmp(kind, names[k]) == 0) chosen_kind = k;
  chosen_number = long_of("FAULT_NUMBER", 0);
  every = long_of("FAULT_EVERY", 1);
  large_bytes = static_cast<size_t>(long_of("FAULT_LARGE", 1 << 20));
  if (const char* talk = std::getenv("FAULT_TALK")) children.emplace(folder, talk);
  is_active = true;
}

__attribute__((destructor)) void end() {
  const char* file = std::getenv("FAULT_COUNTS");
  if (!is_active || file == nullptr) return;
  is_active = false;
  if (std::FILE* out = std::fopen(file, "w")) {
    for (int k = 0; k < n_kinds; ++k) std::fprintf(out, "%s %ld\n", names[k], counts[k].load());
    std::fclose(out);
  }
}

bool writes(const int flags) {
  return (flags & O_ACCMODE) != O_RDONLY || (flags & O_CREAT) != 0;
}

}  // namespace

extern "C" {

#define OPEN(name)                                                                       \
  int name(const char* path, int flags, ...) {                                           \
    va_list rest;                                                                        \
    va_start(rest, flags);                                                               \
    const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;               \
    va_end(rest);                                                                        \
    if (writes(flags) && is_meant(path) && fails(open_kind)) return failure(EACCES, -1); \
    return next<int(const char*, int, mode_t)>(#name)(path, flags, mode);                \
  }
OPEN(open)
OPEN(open64)

#define FOPEN(name)                                                       \
  std::FILE* name(const char* path, const char* mode) {                   \
    if (mode[0] != 'r' && is_meant(path) && fails(open_kind))             \
      return failure<std::FILE*>(EACCES, nullptr);                        \
    return next<std::FILE*(const char*, const char*)>(#name)(path, mode); \
  }
FOPEN(fopen)
FOPEN(fopen64)

int mkdir(const char* path, mode_t mode) noexcept {
  if (is_meant(path) && fails(open_kind)) return failure(EACCES, -1);
  return next<int(const char*, mode_t)>("mkdir")(path, mode);
}

ssize_t write(int file, const void* bytes, size_t n) {
  if (is_meant(file) && fails(write_kind)) return failure<ssize_t>(ENOSPC, -1);
  return next<ssize_t(int, const void*, size_t)>("write")(file, bytes, n);
}
ssize_t writev(int file, const iovec* parts, int n) {
  if (is_meant(file) && fails(write_kind)) return failure<ssize_t>(ENOSPC, -1);
  return next<ssize_t(int, const iovec*, int)>("writev")(file, parts, n);
}
ssize_t pwrite(int file, const void* bytes, size_t n, off_t at) {
  if (is_meant(file) && fails(write_kind)) return failure<ssize_t>(ENOSPC, -1);
  return next<ssize_t(int, const void*, size_t, off_t)>("pwrite")(file, bytes, n, at);
}
ssize_t pwrite64(int file, const void* bytes, size_t n, off64_t at) {
  if (is_meant(file) && fails(write_kind)) return failure<ssize_t>(ENOSPC, -1);
  return next<ssize_t(int, const void*, size_t, off64_t)>("pwrite64")(file, bytes, n, at);
}
size_t fwrite(const void* bytes, size_t size, size_t n, std::FILE* file) {
  if (is_meant(fileno(file)) && fails(write_kind)) return failure<size_t>(ENOSPC, 0);
  return next<size_t(const void*, size_t, size_t, std::FILE*)>("fwrite")(bytes, size, n, file);
}
int fsync(int file) {
  if (is_meant(file) && fails(write_kind)) return failure(EIO, -1);
  return next<int(int)>("fsync")(file);
}

int rename(const char* from, const char* to) noexcept {
  if (is_meant(to) && fails(rename_kind)) return failure(EACCES, -1);
  return next<int(const char*, const char*)>("rename")(from, to);
}

void* malloc(size_t size) noexcept {
  if (size >= large_bytes && fails(memory_kind)) return failure<void*>(ENOMEM, nullptr);
  return __libc_malloc(size);
}
void* calloc(size_t n, size_t size) noexcept {
  if (size != 0 && n >= large_bytes / size && fails(memory_kind))
    return failure<void*>(ENOMEM, nullptr);
  return __libc_calloc(n, size);
}
void* realloc(void* old, size_t size) noexcept {
  if (size >= large_bytes && fails(memory_kind)) return failure<void*>(ENOMEM, nullptr);
  return __libc_realloc(old, size);
}
int posix_memalign(void** block, size_t alignment, size_t size) noexcept {
  if (size >= large_bytes && fails(memory_kind)) return ENOMEM;
  *block = __libc_memalign(alignment, size);
  return *block == nullptr ? ENOMEM : 0;
}
void* aligned_alloc(size_t alignment, size_t size) noexcept {
  if (size >= large_bytes && fails(memory_kind)) return failure<void*>(ENOMEM, nullptr);
  return __libc_memalign(alignment, size);
}
void* memalign(size_t alignment, size_t size) noexcept {
  return aligned_alloc(alignment, size);
}

// Its end would wait for its own thread, which a child has not.
int MPI_Finalize() {
  return is_in_child ? 0 : next<int()>("MPI_Finalize")();
}

pid_t fork() noexcept {
  if (fails(fork_kind)) return failure(EAGAIN, -1);
  return next<pid_t()>("fork")();
}
int system(const char* command) {
  if (fails(fork_kind)) return failure(EAGAIN, -1);
  return next<int(const char*)>("system")(command);
}
std::FILE* popen(const char* command, const char* mode) {
  if (fails(fork_kind)) return failure<std::FILE*>(EAGAIN, nullptr);
  return next<std::FILE*(const char*, const char*)>("popen")(command, mode);
}
#define SPAWN(name)                                                                            \
  int name(pid_t* child, const char* path, const posix_spawn_file_actions_t* actions,          \
           const posix_spawnattr_t* attributes, char* const* arguments, char* const* values) { \
    if (fails(fork_kind)) return EAGAIN;                                                       \
    return next<int(pid_t*, const char*, const posix_spawn_file_actions_t*,                    \
                    const posix_spawnattr_t*, char* const*, char* const*)>(#name)(             \
        child, path, actions, attributes, arguments, values);                                  \
  }
SPAWN(posix_spawn)
SPAWN(posix_spawnp)

}  // extern "C"
