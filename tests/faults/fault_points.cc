// Preloaded (LD_PRELOAD) into a program under test: the Nth call of one kind fails as the system
// would let it fail, or, told no kind, the calls of every kind are counted.
//
// FAULT_PROGRAM  name of the program that is meant; others (its children) run undisturbed
// FAULT_FOLDER   files below it are meant; reading elsewhere is not
// FAULT_KIND     open | write | rename | memory | fork
// FAULT_NUMBER   1 for the first call of this kind
// FAULT_LARGE   bytes from which on an allocation counts (default 1 MiB)
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
int chosen_kind = -1;
long chosen_number = 0;
char folder[PATH_MAX];

bool fails(const Kind kind) {
  if (!is_active) return false;
  return ++counts[kind] == chosen_number && kind == chosen_kind;
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

__attribute__((constructor)) void begin() {
  const char* program = std::getenv("FAULT_PROGRAM");
  const char* where = std::getenv("FAULT_FOLDER");
  if (program == nullptr || where == nullptr ||
      std::strcmp(program, program_invocation_short_name) != 0)
    return;
  std::snprintf(folder, sizeof folder, "%s", where);
  if (const char* kind = std::getenv("FAULT_KIND"))
    for (int k = 0; k < n_kinds; ++k)
      if (std::strcmp(kind, names[k]) == 0) chosen_kind = k;
  if (const char* number = std::getenv("FAULT_NUMBER")) chosen_number = std::atol(number);
  if (const char* bytes = std::getenv("FAULT_LARGE"))
    large_bytes = std::strtoull(bytes, nullptr, 10);
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
