#pragma once

#include <Eigen/Core>
#include <cstring>

namespace vibrissa::signals {

/// Numbers that are computed side by side in one SIMD instruction: one value for each record, mode
/// or sample, as the code that uses them says.
inline constexpr Eigen::Index n_lanes = 8;
using Lanes = Eigen::Array<double, n_lanes, 1>;

/// Lane by lane: then where test is negative, otherwise elsewhere (also where test is NaN). Written
/// with compiler vectors, because Eigen's select and a loop are not compiled to one instruction.
/// Proven by tests/signals/base/lanes_test.cc.
inline Lanes where_negative(const Lanes& test, const Lanes& then, const Lanes& otherwise) {
  using Vector = double __attribute__((vector_size(sizeof(Lanes))));
  Vector t, a, b;
  std::memcpy(&t, test.data(), sizeof t);
  std::memcpy(&a, then.data(), sizeof a);
  std::memcpy(&b, otherwise.data(), sizeof b);
  const Vector chosen = t < 0. ? a : b;
  Lanes out;
  std::memcpy(out.data(), &chosen, sizeof chosen);
  return out;
}

}  // namespace vibrissa::signals
