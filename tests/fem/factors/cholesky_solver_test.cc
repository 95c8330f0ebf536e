#include <gmock/gmock.h>  // before deal.II, whose Assert is a macro

#include "fem/factors/cholesky_solver.h"

#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <random>

#include "fem/factors/mumps_factors.h"
#include "fem/factors/supernodal_factors.h"
#include "fem/solid/internal_force.h"
#include "fem/solid/tangent_matrix.h"
#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

/// The Laplacian of a grid of points with some mass, its unknowns in threes or one by one as n is.
void make_grid(const unsigned int width, const unsigned int height, Matrix& matrix) {
  const unsigned int n = width * height;
  dealii::DynamicSparsityPattern pattern(n, n);
  const auto visit_links = [&](const auto& link) {
    for (unsigned int i = 0; i < n; ++i) {
      if (i % width + 1 < width) link(i, i + 1);
      if (i + width < n) link(i, i + width);
    }
  };
  for (unsigned int i = 0; i < n; ++i) pattern.add(i, i);
  visit_links([&](const unsigned int i, const unsigned int j) {
    pattern.add(i, j);
    pattern.add(j, i);
  });
  const auto all = dealii::complete_index_set(n);
  matrix.reinit(all, all, pattern, MPI_COMM_SELF);
  for (unsigned int i = 0; i < n; ++i) matrix.set(i, i, 4.1 + 0.01 * (i % 7));
  visit_links([&](const unsigned int i, const unsigned int j) {
    matrix.set(i, j, -1.);
    matrix.set(j, i, -1.);
  });
  matrix.compress(dealii::VectorOperation::insert);
}

Columns random_columns(const Eigen::Index n, const Eigen::Index n_columns) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform(-1., 1.);
  return Columns::NullaryExpr(n, n_columns, [&] { return uniform(generator); });
}

class GridOfPoints : public testing::TestWithParam<unsigned int> {};

TEST_P(GridOfPoints, IsSolvedForOneAndForSeveralRightHandSides) {
  Matrix matrix;
  make_grid(GetParam(), 40, matrix);
  const CholeskySolver solver(matrix);
  const Columns right = random_columns(static_cast<Eigen::Index>(matrix.m()), 5);
  const Columns found = solver.solve(right);
  EXPECT_LT((multiply(matrix, found) - right).norm(), 1e-13 * right.norm());
  Vector b(MPI_COMM_SELF, matrix.m(), matrix.m()), x(b);
  set_owned_entries(right.col(1), b);
  solver.solve_once(b, x);
  EXPECT_LT((owned_entries(x) - found.col(1)).norm(), 1e-14 * found.col(1).norm());
}

INSTANTIATE_TEST_SUITE_P(ByNodesAndByUnknowns, GridOfPoints, testing::Values(30U, 31U));

class SensorStiffness : public testing::Test {
 protected:
  SensorStiffness() : sensor(whisker_sensor(1)) {}
  const Matrix& stiffness() const { return *sensor.operators().clamped_stiffness; }
  Sensor sensor;
};

TEST_F(SensorStiffness, LeadsToTheSolutionOfMumps) {
  SupernodalFactors ours(stiffness());
  MumpsFactors theirs(stiffness());
  ours.factorise();
  theirs.factorise();
  const Columns right = random_columns(static_cast<Eigen::Index>(stiffness().m()), 8);
  const Columns x = ours.solve(right), y = theirs.solve(right);
  EXPECT_LT((x - y).norm(), 1e-5 * y.norm());  // a slender solid magnifies the rounding of both
  EXPECT_LT((multiply(stiffness(), x) - right).norm(),
            3. * (multiply(stiffness(), y) - right).norm());
  EXPECT_LT(ours.cost().entries, 1.3 * theirs.cost().entries);
  EXPECT_GT(ours.cost().memory_mib, 8. * ours.cost().entries / 1048576.);
}

TEST_F(SensorStiffness, IsTheSameInBlocksAndInSingleEntries) {
  TangentMatrix tangent(sensor.space(), *sensor.operators().mass, sensor.space().clamped());
  const Vector rest = sensor.space().make_vector();
  tangent.start(0.);
  sensor.operators().internal_force->add_tangent(1., rest, rest, tangent);
  tangent.finish();
  const Columns right = random_columns(static_cast<Eigen::Index>(stiffness().m()), 1);
  const Columns x = CholeskySolver(stiffness()).solve(right);
  const Columns y = CholeskySolver(tangent.matrix()).solve(right);
  EXPECT_LT((x - y).norm(), 1e-5 * x.norm());
}

TEST_F(SensorStiffness, GivesTheSameBitsAgain) {
  CholeskySolver solver(stiffness());
  const Columns right = random_columns(static_cast<Eigen::Index>(stiffness().m()), 1);
  const Columns first = solver.solve(right);
  solver.refactor();
  EXPECT_EQ(solver.solve(right), first);
  EXPECT_EQ(CholeskySolver(stiffness()).solve(right), first);
}

TEST(CholeskySolver, TellsAMatrixThatHasBecomeIndefinite) {
  dealii::DynamicSparsityPattern diagonal(6, 6);
  for (unsigned int i = 0; i < 6; ++i) diagonal.add(i, i);
  const dealii::IndexSet rows = dealii::complete_index_set(6);
  Matrix matrix;
  matrix.reinit(rows, rows, diagonal, MPI_COMM_SELF);
  const auto fill = [&](const double last) {
    for (unsigned int i = 0; i < 6; ++i) matrix.set(i, i, i == 5 ? last : 1.);
    matrix.compress(dealii::VectorOperation::insert);
  };
  fill(2.);
  CholeskySolver solver(matrix);
  fill(4.);
  solver.refactor();
  Vector b(MPI_COMM_SELF, 6, 6), x(b);
  b = 1.;
  solver.solve_once(b, x);
  EXPECT_DOUBLE_EQ(x[5], 0.25);
  fill(-1.);
  EXPECT_THROW(solver.refactor(), IndefiniteMatrix);
}

}  // namespace
}  // namespace vibrissa::fem
