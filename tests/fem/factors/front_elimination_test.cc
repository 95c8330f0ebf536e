#include "fem/factors/front_elimination.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

namespace vibrissa::fem {
namespace {

struct Shape {
  int n_rows, n_columns;
};

class Fronts : public testing::TestWithParam<Shape> {
 protected:
  Fronts() : matrix(Eigen::MatrixXd::Zero(GetParam().n_rows, GetParam().n_rows)) {
    const auto n = matrix.rows();
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        matrix(i, j) = i == j ? static_cast<double>(n) : 1. / (1. + std::abs(double(i - j)));
  }
  DenseBlock block() { return {matrix.data(), GetParam().n_rows}; }
  Eigen::MatrixXd matrix;
};

TEST_P(Fronts, LoseTheirFirstColumnsAsADenseCholeskyFactorisationDoes) {
  const auto [n_rows, n_columns] = GetParam();
  const Eigen::MatrixXd expected = matrix.llt().matrixL();
  const int n_below = n_rows - n_columns;
  FrontElimination elimination(n_rows);
  ASSERT_TRUE(elimination.eliminate(n_rows, n_columns, block()));
  elimination.subtract_square(n_below, n_below, n_columns, block().at(n_columns, 0),
                              block().at(n_columns, n_columns));
  ASSERT_TRUE(elimination.eliminate(n_below, n_below, block().at(n_columns, n_columns)));
  const Eigen::MatrixXd found = matrix.triangularView<Eigen::Lower>();
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_P(Fronts, AreIndefiniteByTheirLastColumn) {
  const auto [n_rows, n_columns] = GetParam();
  matrix(n_columns - 1, n_columns - 1) = -1.;
  EXPECT_FALSE(FrontElimination(n_rows).eliminate(n_rows, n_columns, block()));
}

INSTANTIATE_TEST_SUITE_P(OfAllSizes, Fronts,
                         testing::Values(Shape{1, 1}, Shape{9, 3}, Shape{24, 8}, Shape{100, 47},
                                         Shape{143, 96}, Shape{301, 145}, Shape{400, 400}));

}  // namespace
}  // namespace vibrissa::fem
