#pragma once

#include <string>
#include <string_view>

namespace vibrissa::apps {

/// What OpenBLAS calls the kernel that it runs ("Haswell"); empty with another BLAS.
std::string blas_kernel_name();

/// What it runs on a processor that it does not know.
inline constexpr std::string_view slow_blas_kernel = "Prescott";

/// OpenBLAS falls back to twenty-year-old kernels on processors that are newer than it, which makes
/// the factorisation several times slower. When it does so on a processor with AVX2 or AVX-512,
/// starts this program again with the kernel named (OPENBLAS_CORETYPE); does nothing when that
/// variable is set or another BLAS is in use. Call first in main.
void use_fast_blas_kernel(char** arguments);

}  // namespace vibrissa::apps
