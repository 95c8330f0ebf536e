#include "fem/solvers/block_lanczos.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "signals/base/error.h"

namespace vibrissa::fem {

namespace {

constexpr Eigen::Index block_size = 8;
constexpr Eigen::Index columns_each = 16;    // the basis may grow to this many for each pair
constexpr double residual_tolerance = 1e-9;  // relative to the pair's own 1 / lambda
constexpr double rounding = 1e-15;           // relative to the largest 1 / lambda
constexpr double lost = 1e-13;               // part of a column's length below which it is rounding
constexpr double dependence = 1e-13;         // squared part of a scaled column, likewise
constexpr double independence = 1e-4;        // squared part that one orthonormalisation is good for
constexpr double apart = 1e-3;               // relative distance of eigenvalues that are no pair

class Lanczos {
 public:
  Lanczos(const CholeskySolver& stiffness, const Matrix& mass)
      : stiffness_(stiffness), mass_(mass) {
    basis_.resize(static_cast<Eigen::Index>(mass.locally_owned_domain_indices().n_elements()), 0);
    mass_basis_ = basis_;
  }

  void run(Eigen::Index n, Eigen::Index n_beyond);
  std::vector<Eigenpair> pairs(Eigen::Index n) const;

 private:
  Columns random_block() const;
  Columns inner(const Columns& x, const Columns& y) const {
    return sum_over_processes(x.transpose() * y, mass_.get_mpi_communicator());
  }
  void append(const Columns& block, const Columns& mass_block);
  Columns extend(Columns image);
  Eigen::VectorXd take_basis_out(Columns& block) const;
  struct Factor {
    Columns r;
    bool is_well_conditioned;
  };
  Factor orthonormalise(Columns& block, Columns& mass_block, const Eigen::VectorXd& shortest) const;
  bool converged(Eigen::Index n, Eigen::Index n_beyond, const Columns& beyond) const;

  const CholeskySolver& stiffness_;
  const Matrix& mass_;
  Columns basis_, mass_basis_;                   // V with V^T M V = I, and M V
  Columns projected_;                            // V^T M K^-1 M V
  Eigen::Index newest_ = 0;                      // columns of the newest block
  Eigen::SelfAdjointEigenSolver<Columns> ritz_;  // of projected_: 1 / lambda, ascending
};

Columns Lanczos::random_block() const {
  const auto owned = mass_.locally_owned_domain_indices();
  std::mt19937_64 generator(owned.is_empty() ? 0 : owned.nth_index_in_set(0));
  std::uniform_real_distribution<double> uniform(-1., 1.);
  return Columns::NullaryExpr(static_cast<Eigen::Index>(owned.n_elements()), block_size,
                              [&] { return uniform(generator); });
}

void Lanczos::append(const Columns& block, const Columns& mass_block) {
  const auto old = basis_.cols();
  newest_ = block.cols();
  basis_.conservativeResize(block.rows(), old + newest_);
  mass_basis_.conservativeResize(block.rows(), old + newest_);
  basis_.rightCols(newest_) = block;
  mass_basis_.rightCols(newest_) = mass_block;
}

// Takes the image's part within the basis out and appends what is left, orthonormal. Returns the
// factor R of that rest: rest = (appended columns) R.
Columns Lanczos::extend(Columns image) {
  Eigen::VectorXd within = take_basis_out(image);
  within += take_basis_out(image);  // once more for what the rounding of the first left
  Columns mass_image = multiply(mass_, image);
  auto [r, is_well_conditioned] = orthonormalise(image, mass_image, lost * within.cwiseSqrt());
  newest_ = image.cols();
  if (newest_ == 0) return r;
  if (!is_well_conditioned) {
    take_basis_out(image);
    mass_image = multiply(mass_, image);
    r = (orthonormalise(image, mass_image, Eigen::VectorXd::Zero(image.cols())).r * r).eval();
  }
  append(image, mass_image);
  return r;
}

// Returns the squared length of what it takes out of each column.
Eigen::VectorXd Lanczos::take_basis_out(Columns& block) const {
  const Columns within = inner(mass_basis_, block);
  block -= basis_ * within;
  return within.colwise().squaredNorm();
}

// block = Q R with Q^T M Q = I, from the eigenvectors of its scaled Gram matrix (Stathopoulos and
// Wu, SIAM J. Sci. Comput. 23, 2165 (2002)): columns that depend on others or are not longer than
// stated leave, and Q has fewer columns than the block.
Lanczos::Factor Lanczos::orthonormalise(Columns& block, Columns& mass_block,
                                        const Eigen::VectorXd& shortest) const {
  const Columns gram = inner(block, mass_block);
  const Eigen::VectorXd lengths = gram.diagonal().cwiseMax(0.).cwiseSqrt();
  const Eigen::VectorXd scale =
      (lengths.array() > shortest.array()).select(lengths.cwiseInverse(), 0.);
  const Eigen::SelfAdjointEigenSolver<Columns> eigen(scale.asDiagonal() * gram *
                                                     scale.asDiagonal());
  const auto kept = (eigen.eigenvalues().array() > dependence).count();
  const Eigen::VectorXd roots = eigen.eigenvalues().tail(kept).cwiseSqrt();
  const Columns directions = eigen.eigenvectors().rightCols(kept);
  const Columns to_unit = scale.asDiagonal() * directions * roots.cwiseInverse().asDiagonal();
  block = (block * to_unit).eval();
  mass_block = (mass_block * to_unit).eval();
  return {roots.asDiagonal() * directions.transpose() * lengths.asDiagonal(),
          kept == gram.cols() && eigen.eigenvalues()[0] > independence};
}

// The residual K^-1 M x - x / lambda of a Ritz pair is what its newest image has beyond the basis.
bool Lanczos::converged(const Eigen::Index n, const Eigen::Index n_beyond,
                        const Columns& beyond) const {
  const auto size = projected_.cols();
  if (size < n + n_beyond) return false;
  const Eigen::VectorXd& values = ritz_.eigenvalues();
  const auto block = beyond.cols(), last = size - n;
  for (auto i = last - n_beyond; i < size; ++i) {
    const double residual =
        (beyond * ritz_.eigenvectors().col(i).segment(size - block, block)).norm();
    const bool is_apart = i < last && values[i] + residual < (1. - apart) * values[last];
    if (!is_apart && residual > residual_tolerance * values[i] + rounding * values[size - 1])
      return false;
  }
  return true;
}

void Lanczos::run(const Eigen::Index n, const Eigen::Index n_beyond) {
  extend(stiffness_.solve(multiply(mass_, random_block())));
  const auto most = std::max<Eigen::Index>(columns_each * (n + n_beyond), 10 * block_size);
  while (true) {
    const Columns image = stiffness_.solve(mass_basis_.rightCols(newest_));
    const Columns coupling = inner(mass_basis_, image);
    const auto size = basis_.cols();
    projected_.conservativeResize(size, size);
    projected_.rightCols(newest_) = coupling;
    projected_.bottomRows(newest_) = coupling.transpose();
    ritz_.compute(projected_);
    const Columns beyond = extend(image);
    const bool nothing_left = newest_ == 0;
    if (nothing_left || converged(n, n_beyond, beyond)) return;
    if (size > most) {
      throw signals::InternalError("the modes did not converge within a basis of " +
                                   std::to_string(size) +
                                   " vectors; request fewer modes or refine the mesh");
    }
  }
}

std::vector<Eigenpair> Lanczos::pairs(const Eigen::Index n) const {
  const auto size = projected_.cols();
  const auto count = std::min(n, size);
  const Columns vectors =
      basis_.leftCols(size) * ritz_.eigenvectors().rightCols(count).rowwise().reverse();
  const auto owned = mass_.locally_owned_domain_indices();
  std::vector<Eigenpair> pairs;
  for (Eigen::Index k = 0; k < count; ++k) {
    auto& pair = pairs.emplace_back();
    pair.eigenvalue = 1. / ritz_.eigenvalues()[size - 1 - k];
    pair.vector = Vector(owned, mass_.get_mpi_communicator());
    set_owned_entries(vectors.col(k), pair.vector);
  }
  return pairs;
}

}  // namespace

std::vector<Eigenpair> smallest_eigenpairs(const CholeskySolver& stiffness, const Matrix& mass,
                                           const unsigned int n, const unsigned int n_beyond) {
  Lanczos lanczos(stiffness, mass);
  lanczos.run(n, n_beyond);
  return lanczos.pairs(n + n_beyond);
}

}  // namespace vibrissa::fem
