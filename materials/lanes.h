#pragma once

#include <cstring>

namespace vibrissa::materials {

/// Numbers for SIMD operations; the compiler splits them on processors with shorter registers. Pass
/// them only by reference: by value they would change the calling convention.
inline constexpr int n_lanes = 8;
using Lanes [[gnu::vector_size(n_lanes * sizeof(double))]] = double;

inline void load(Lanes& lanes, const double* from) {
  std::memcpy(&lanes, from, sizeof lanes);
}
inline void store(const Lanes& lanes, double* to) {
  std::memcpy(to, &lanes, sizeof lanes);
}

/// The next multiple of n_lanes.
constexpr int padded(const int n) {
  return (n + n_lanes - 1) / n_lanes * n_lanes;
}

}  // namespace vibrissa::materials
