#include "fem/solvers/secant_memory.h"

#include <vector>

namespace vibrissa::fem {

void SecantMemory::add(const Vector& step, const Vector& growth) {
  constexpr double rounding = 1e-12;
  const double work = step * growth;
  if (n_pairs_ == 0 || !(work > rounding * step.l2_norm() * growth.l2_norm())) return;
  if (pairs_.size() == n_pairs_) pairs_.pop_front();
  pairs_.push_back({step, growth, work});
}

void SecantMemory::solve(const Solve& by_factors, const Vector& force, Vector& step) const {
  Vector rest(force);
  std::vector<double> share(pairs_.size());
  for (std::size_t i = pairs_.size(); i-- > 0;) {
    share[i] = (pairs_[i].step * rest) / pairs_[i].work;
    rest.add(-share[i], pairs_[i].growth);
  }
  by_factors(rest, step);
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    step.add(share[i] - (pairs_[i].growth * step) / pairs_[i].work, pairs_[i].step);
}

}  // namespace vibrissa::fem
