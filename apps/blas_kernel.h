#pragma once

namespace vibrissa::apps {

/// OpenBLAS falls back to twenty-year-old kernels on processors that are newer than it, which makes
/// the factorisation several times slower. When it does so on a processor with AVX2 or AVX-512,
/// starts this program again with the kernel named (OPENBLAS_CORETYPE); does nothing when that
/// variable is set or another BLAS is in use. Call first in main.
void use_fast_blas_kernel(char** arguments);

}  // namespace vibrissa::apps
