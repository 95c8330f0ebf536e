#pragma once

#include <cstddef>
#include <deque>
#include <functional>

#include "fem/linalg/linear_algebra.h"

namespace vibrissa::fem {

/// What the last steps of an iteration have shown of a stiffness beside a factorised one that is no
/// longer true: limited-memory BFGS on its inverse (Nocedal and Wright, Numerical
/// Optimization, 2006, algorithm 7.4). Stays positive definite. Proven by
/// tests/fem/solvers/newton_test.cc.
class SecantMemory {
 public:
  explicit SecantMemory(std::size_t n_pairs) : n_pairs_(n_pairs) {}

  void clear() { pairs_.clear(); }
  /// A step and by how much the resisting force grew along it. A pair that no positive definite
  /// stiffness has is left out.
  void add(const Vector& step, const Vector& growth);
  /// step = approximate inverse times force; solve: by the factorised stiffness.
  using Solve = std::function<void(const Vector& force, Vector& step)>;
  void solve(const Solve& by_factors, const Vector& force, Vector& step) const;

 private:
  struct Pair {
    Vector step, growth;
    double work;  // step . growth
  };
  std::size_t n_pairs_;
  std::deque<Pair> pairs_;  // oldest first
};

}  // namespace vibrissa::fem
