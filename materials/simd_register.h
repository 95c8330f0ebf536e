#pragma once

#include <cstring>

namespace vibrissa::materials {

/// Numbers for SIMD operations; the compiler splits them on processors with shorter registers. Pass
/// them only by reference: by value they would change the calling convention.
inline constexpr int register_size = 8;
using Register [[gnu::vector_size(register_size * sizeof(double))]] = double;

inline void load(Register& lanes, const double* from) {
  std::memcpy(&lanes, from, sizeof lanes);
}
inline void store(const Register& lanes, double* to) {
  std::memcpy(to, &lanes, sizeof lanes);
}

/// The next multiple of register_size.
constexpr int padded(const int n) {
  return (n + register_size - 1) / register_size * register_size;
}

}  // namespace vibrissa::materials
