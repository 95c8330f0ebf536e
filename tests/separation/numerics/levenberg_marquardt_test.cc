#include "separation/numerics/levenberg_marquardt.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

namespace vibrissa::separation {
namespace {

// From the residuals and J = -de/dparameter.
NormalEquations equations(const Eigen::VectorXd& e, const Eigen::MatrixXd& j) {
  return {.matrix = j.transpose() * j, .gradient = j.transpose() * e, .cost = e.squaredNorm()};
}

// Rosenbrock's valley as a sum of squares, its minimum 0 at (1, 1).
bool rosenbrock(const Eigen::VectorXd& p, NormalEquations& out) {
  const Eigen::Vector2d e(10. * (p[1] - p[0] * p[0]), 1. - p[0]);
  Eigen::Matrix2d j;
  j << 20. * p[0], -10., 1., 0.;
  out = equations(e, j);
  return true;
}

TEST(LevenbergMarquardt, FollowsRosenbrocksValleyToItsEnd) {
  const auto result =
      minimise(Eigen::Vector2d(-1.2, 1.), rosenbrock,
               {.max_iterations = 100, .n_residuals = 2., .negligible_cost = 1e-26});
  EXPECT_EQ(result.end, FitEnd::converged);
  EXPECT_NEAR(result.parameters[0], 1., 1e-9);
  EXPECT_NEAR(result.parameters[1], 1., 1e-9);
}

TEST(LevenbergMarquardt, SaysWhenItRanOutOfSteps) {
  const auto result =
      minimise(Eigen::Vector2d(-1.2, 1.), rosenbrock, {.max_iterations = 4, .n_residuals = 2.});
  EXPECT_EQ(result.end, FitEnd::step_limit);
  EXPECT_EQ(result.n_iterations, 4);
}

TEST(LevenbergMarquardt, SolvesALinearProblemLikeLeastSquares) {
  const Eigen::MatrixXd j =
      Eigen::MatrixXd::Random(50, 4) * Eigen::Vector4d(1., 1e6, 1e-6, 3.).asDiagonal();
  const Eigen::VectorXd y = Eigen::VectorXd::Random(50);
  const auto result = minimise(Eigen::Vector4d::Zero(),
                               [&](const Eigen::VectorXd& p, NormalEquations& out) {
                                 out = equations(y - j * p, j);
                                 return true;
                               },
                               {.n_residuals = 50., .negligible_cost = 0.});
  const Eigen::VectorXd exact = j.colPivHouseholderQr().solve(y);
  EXPECT_EQ(result.end, FitEnd::converged);
  EXPECT_LT(((result.parameters - exact).array() / exact.array()).abs().maxCoeff(), 1e-6);
}

TEST(LevenbergMarquardt, SaysWhenAParameterHasNoEffect) {
  const auto result = minimise(Eigen::Vector2d(5., 1.),
                               [](const Eigen::VectorXd& p, NormalEquations& out) {
                                 Eigen::MatrixXd j(3, 2);
                                 j << 1., 1., 2., 2., 3., 3.;
                                 out = equations(Eigen::Vector3d(1., 2.1, 3.) - j * p, j);
                                 return true;
                               },
                               {.n_residuals = 3.});
  EXPECT_EQ(result.end, FitEnd::poor_excitation);
}

// The least cost lies at p = -1, where no step may go.
TEST(LevenbergMarquardt, SaysWhenTheBestFitIsNotAdmissible) {
  const auto result =
      minimise(Eigen::VectorXd::Constant(1, 2.),
               [](const Eigen::VectorXd& p, NormalEquations& out) {
                 if (p[0] <= 0.) return false;
                 out = equations(Eigen::Vector2d(-1. - p[0], 1.), Eigen::Vector2d(1., 0.));
                 return true;
               },
               {.max_iterations = 500, .n_residuals = 2.});
  EXPECT_EQ(result.end, FitEnd::unstable);
  EXPECT_GT(result.parameters[0], 0.);
}

TEST(InverseInformation, IsTheInverseWhateverTheUnits) {
  Eigen::Matrix2d matrix;
  matrix << 4e20, 1e3, 1e3, 1e-10;
  const Eigen::MatrixXd product = inverse_information(matrix) * matrix;
  EXPECT_NEAR(product(0, 0), 1., 1e-12);
  EXPECT_NEAR(product(1, 1), 1., 1e-12);
  EXPECT_EQ(inverse_information(Eigen::Matrix2d::Constant(3.)).size(), 0);
}

}  // namespace
}  // namespace vibrissa::separation
