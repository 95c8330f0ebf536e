#pragma once

#include <Eigen/Core>
#include <cstring>

namespace vibrissa::diagnosis {

/// One value for each of the records that are integrated in parallel (SIMD).
using Lanes = Eigen::Array<double, 8, 1>;

/// Lane by lane: then where test is negative, otherwise elsewhere (also where test is NaN). Written
/// with compiler vectors, because Eigen's select and a loop are not compiled to one instruction.
/// Proven by tests/diagnosis/model/lanes_test.cc.
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

}  // namespace vibrissa::diagnosis
