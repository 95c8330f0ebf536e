#include "separation/numerics/gram_matrix.h"

#include <gtest/gtest.h>

namespace vibrissa::separation {
namespace {

TEST(GramMatrix, IsTheSumOfInnerProductsOverAllBlocks) {
  for (const Eigen::Index n_columns : {1, 3, 5, 16}) {
    GramMatrix gram(n_columns);
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(n_columns, n_columns);
    for (const Eigen::Index n_rows : {256, 255, 1}) {
      const Eigen::MatrixXd block = Eigen::MatrixXd::Random(n_rows, n_columns);
      for (Eigen::Index j = 0; j < n_columns; ++j)
        Eigen::Map<Eigen::VectorXd>(gram.column(j), n_rows) = block.col(j);
      gram.add(n_rows, n_columns);
      expected += block.transpose() * block;
    }
    EXPECT_LT((gram.matrix() - expected).cwiseAbs().maxCoeff(), 1e-12) << n_columns;
  }
}

TEST(GramMatrix, LeavesColumnsBeyondTheGivenNumberOut) {
  GramMatrix gram(5);
  for (Eigen::Index j = 0; j < 5; ++j)
    Eigen::Map<Eigen::VectorXd>(gram.column(j), 10).setConstant(j + 1.);
  gram.add(10, 3);
  EXPECT_EQ(gram.matrix()(2, 1), 60.);
  EXPECT_EQ(gram.matrix()(4, 1), 0.);
}

TEST(GramMatrix, ForgetsWhenCleared) {
  GramMatrix gram(2);
  gram.column(0)[0] = 3.;
  gram.add(1, 2);
  EXPECT_EQ(gram.matrix()(0, 0), 9.);
  gram.clear();
  EXPECT_EQ(gram.matrix()(0, 0), 0.);
}

}  // namespace
}  // namespace vibrissa::separation
