#include <gmock/gmock.h>  // before deal.II, whose Assert is a macro

#include "fem/solvers/block_lanczos.h"

#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <Eigen/Eigenvalues>

#include "fem/factors/cholesky_solver.h"

namespace vibrissa::fem {
namespace {

/// Three equal chains of springs and masses side by side, so that every eigenvalue comes three
/// times; the first mass of each is massless (a clamp's row).
class ThreeChains : public testing::Test {
 protected:
  static constexpr unsigned int chain = 60, n = 3 * chain;

  ThreeChains() {
    dealii::DynamicSparsityPattern pattern(n, n);
    for (unsigned int i = 0; i < n; ++i) {
      pattern.add(i, i);
      if (i >= 3) pattern.add(i, i - 3);
      if (i + 3 < n) pattern.add(i, i + 3);
    }
    const auto all = dealii::complete_index_set(n);
    for (auto* matrix : {&stiffness, &mass}) matrix->reinit(all, all, pattern, MPI_COMM_SELF);
    for (unsigned int i = 0; i < n; ++i) {
      stiffness.set(i, i, 2. + 0.01 * (i / 3));
      if (i >= 3) stiffness.set(i, i - 3, -1.);
      if (i + 3 < n) stiffness.set(i, i + 3, -1.);
      mass.set(i, i, i < 3 ? 0. : 1. + 0.1 * ((i / 3) % 5));
    }
    for (auto* matrix : {&stiffness, &mass}) matrix->compress(dealii::VectorOperation::insert);
  }

  // Ascending; of the flexibility, as the mass is singular.
  Eigen::VectorXd dense_eigenvalues() const {
    Eigen::MatrixXd k(n, n), m(n, n);
    for (unsigned int i = 0; i < n; ++i) {
      for (unsigned int j = 0; j < n; ++j) {
        k(i, j) = stiffness.el(i, j);
        m(i, j) = mass.el(i, j);
      }
    }
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(m, k);
    return eigen.eigenvalues().reverse().cwiseInverse();
  }

  Matrix stiffness, mass;
};

class SomeOfThreeChains : public ThreeChains, public testing::WithParamInterface<unsigned int> {};

TEST_P(SomeOfThreeChains, GiveTheSmallestEigenvaluesOfADenseSolverWithAllTheirCopies) {
  const CholeskySolver factors(stiffness);
  const auto pairs = smallest_eigenpairs(factors, mass, GetParam());
  const Eigen::VectorXd expected = dense_eigenvalues();
  ASSERT_EQ(pairs.size(), GetParam());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    EXPECT_NEAR(pairs[k].eigenvalue, expected[static_cast<Eigen::Index>(k)],
                1e-12 * expected[static_cast<Eigen::Index>(k)])
        << k;
  }
}

TEST_P(SomeOfThreeChains, VectorsAreOrthonormalInMassAndSolveTheProblem) {
  const auto pairs = smallest_eigenpairs(CholeskySolver(stiffness), mass, GetParam());
  Vector force(pairs[0].vector), momentum(pairs[0].vector);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    mass.vmult(momentum, pairs[k].vector);
    for (std::size_t j = 0; j < pairs.size(); ++j) {
      EXPECT_NEAR(momentum * pairs[j].vector, j == k ? 1. : 0., 1e-11) << j << " " << k;
    }
    stiffness.vmult(force, pairs[k].vector);
    const double length = force.l2_norm();
    force.add(-pairs[k].eigenvalue, momentum);
    EXPECT_LT(force.l2_norm(), 1e-7 * length) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(FewAndMany, SomeOfThreeChains, testing::Values(1u, 7u, 40u));

TEST_F(ThreeChains, HaveConvergedBeyondTheNthWhereTheyEqualIt) {
  const CholeskySolver factors(stiffness);
  const Eigen::VectorXd expected = dense_eigenvalues();
  const auto equal = smallest_eigenpairs(factors, mass, 1, 2);
  ASSERT_EQ(equal.size(), 3U);
  for (const auto& pair : equal) EXPECT_NEAR(pair.eigenvalue, expected[0], 1e-12 * expected[0]);
  const auto apart = smallest_eigenpairs(factors, mass, 3, 1);
  ASSERT_EQ(apart.size(), 4U);
  for (Eigen::Index k = 0; k < 3; ++k)
    EXPECT_NEAR(apart[static_cast<std::size_t>(k)].eigenvalue, expected[k], 1e-12 * expected[k]);
  EXPECT_GT(apart[3].eigenvalue, 1.001 * expected[2]);
}

TEST_F(ThreeChains, AreGivenInFullWhenMoreAreAskedForThanThereAre) {
  const auto pairs = smallest_eigenpairs(CholeskySolver(stiffness), mass, n);
  EXPECT_EQ(pairs.size(), n - 3);  // three have no mass
}

}  // namespace
}  // namespace vibrissa::fem
