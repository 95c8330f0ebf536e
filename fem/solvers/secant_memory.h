#pragma once

#include <cstddef>
#include <deque>
#include <functional>

#include "fem/linalg/linear_algebra.h"

namespace vibrissa::fem {

/// Corrects an outdated factorised stiffness by the last steps of an iteration: limited-memory BFGS
/// on its inverse (Nocedal and Wright, Numerical Optimization, 2006, algorithm 7.4). The result
/// stays positive definite. Proven by tests/fem/solvers/newton_test.cc.
class SecantMemory {
 public:
  explicit SecantMemory(std::size_t n_pairs) : n_pairs_(n_pairs) {}

  void clear() { pairs_.clear(); }
  /// Adds a step and the growth of the resisting force along it. A pair that contradicts a positive
  /// definite stiffness is ignored.
  void add(const Vector& step, const Vector& growth);
  /// step = approximate inverse times force; by_factors solves with the factorised stiffness.
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
