#include "fem/sensor/low_rank_damping.h"

#include <cassert>
#include <utility>

namespace vibrissa::fem {

LowRankDamping::LowRankDamping(const ModalDamping& damping, const dealii::IndexSet& held,
                               const double scale) {
  for (std::size_t k = 0; k < damping.n_modes(); ++k) {
    if (damping.coefficient(k) == 0.) continue;
    forces_.push_back(damping.force(k));
    zero_entries(forces_.back(), held);
    weights_.push_back(scale * damping.coefficient(k));
  }
}

void LowRankDamping::renew(std::vector<Vector> solved) {
  assert(solved.size() == forces_.size());
  solved_ = std::move(solved);
  const auto n = static_cast<Eigen::Index>(forces_.size());
  Eigen::MatrixXd small(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto row = static_cast<std::size_t>(i);
    for (Eigen::Index j = 0; j < n; ++j)
      small(i, j) = forces_[row] * solved_[static_cast<std::size_t>(j)];
    small(i, i) += 1. / weights_[row];
  }
  small_.compute(small);
}

void LowRankDamping::correct(Vector& solution) const {
  if (forces_.empty()) return;
  Eigen::VectorXd work(static_cast<Eigen::Index>(forces_.size()));
  for (std::size_t k = 0; k < forces_.size(); ++k)
    work[static_cast<Eigen::Index>(k)] = forces_[k] * solution;
  const Eigen::VectorXd correction = small_.solve(work);
  for (std::size_t k = 0; k < forces_.size(); ++k)
    solution.add(-correction[static_cast<Eigen::Index>(k)], solved_[k]);
}

void LowRankDamping::add(const double factor, const Vector& u, Vector& force) const {
  for (std::size_t k = 0; k < forces_.size(); ++k)
    force.add(factor * weights_[k] * (forces_[k] * u), forces_[k]);
}

}  // namespace vibrissa::fem
