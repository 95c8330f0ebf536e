#include "apps/solid/blas_kernel.h"

#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>

namespace vibrissa::apps {

std::string blas_kernel_name() {
  using NameFunction = const char* (*)();
  const auto name = reinterpret_cast<NameFunction>(dlsym(RTLD_DEFAULT, "openblas_get_corename"));
  return name == nullptr ? "" : name();
}

void use_fast_blas_kernel(char** arguments) {
#if defined(__x86_64__)
  constexpr const char* variable = "OPENBLAS_CORETYPE";
  if (std::getenv(variable) != nullptr) return;
  if (blas_kernel_name() != slow_blas_kernel) return;
  __builtin_cpu_init();
  const char* better = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")
                           ? "SkylakeX"
                       : __builtin_cpu_supports("avx2") ? "Haswell"
                                                        : nullptr;
  if (better == nullptr) return;
  setenv(variable, better, 1);
  // Comes back only when it fails; then the slow kernel has to do.
  execv("/proc/self/exe", arguments);
#else
  static_cast<void>(arguments);
#endif
}

}  // namespace vibrissa::apps
