#include "fem/solvers/eigenpair_refinement.h"

#include <Eigen/Eigenvalues>

namespace vibrissa::fem {

namespace {

void take_residual(const Columns& right, const Columns& x, const StiffnessProduct& product,
                   const Vector& like, Columns& residual) {
  Vector in(like), out(like);
  residual.resize(x.rows(), x.cols());
  for (Eigen::Index k = 0; k < x.cols(); ++k) {
    set_owned_entries(x.col(k), in);
    product(in, out);
    residual.col(k) = right.col(k) - owned_entries(out);
  }
}

}  // namespace

void refine(std::vector<Eigenpair>& pairs, const CholeskySolver& stiffness,
            const StiffnessProduct& product, const Matrix& mass) {
  if (pairs.empty()) return;
  const auto communicator = mass.get_mpi_communicator();
  const auto n = static_cast<Eigen::Index>(pairs.size());
  Columns image(static_cast<Eigen::Index>(mass.local_size()), n);
  Eigen::VectorXd eigenvalues(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto& pair = pairs[static_cast<std::size_t>(k)];
    eigenvalues[k] = pair.eigenvalue;
    image.col(k) = owned_entries(pair.vector);
  }
  // The vectors solve K image = right except for their own error, which a solution with the factors
  // removes.
  const Columns right = multiply(mass, image) * eigenvalues.asDiagonal();
  Columns residual;
  take_residual(right, image, product, pairs[0].vector, residual);
  image += stiffness.solve(residual);
  // K image = right, as exactly as the residual is.
  const Columns energy = sum_over_processes(image.transpose() * right, communicator);
  const Columns gram = sum_over_processes(image.transpose() * multiply(mass, image), communicator);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Columns> ritz(0.5 * (energy + energy.transpose()),
                                                               0.5 * (gram + gram.transpose()));
  const Columns vectors = image * ritz.eigenvectors();
  for (Eigen::Index k = 0; k < n; ++k) {
    auto& pair = pairs[static_cast<std::size_t>(k)];
    pair.eigenvalue = ritz.eigenvalues()[k];
    set_owned_entries(vectors.col(k), pair.vector);
  }
}

}  // namespace vibrissa::fem
