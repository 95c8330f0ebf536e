#include "fem/solid/internal_force.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/solid/solid_operators.h"
#include "meshes/regions.h"
#include "meshes/sensor_mesh.h"
#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

class CoarseWhisker : public testing::Test {
 protected:
  CoarseWhisker() {
    const auto parameters = whisker_sensor(1);
    meshes::make_sensor_mesh(parameters.geometry, 1, mesh);
    space = std::make_unique<SolidSpace>(mesh);
    operators = assemble_operators(*space, parameters.materials.by_region());
    tangent = std::make_unique<TangentMatrix>(*space, *operators.mass, space->clamped());
  }

  /// A smooth motion, zero at the clamp: bent and twisted.
  Vector bow(const double size) const {
    Vector u = space->make_vector();
    for (const auto i : u.locally_owned_elements()) {
      // Height, but for the components along z.
      const double z = space->rotation(1)[i] - space->rotation(0)[i];
      u[i] = size * z * (2. * z + 2. * space->rotation(2)[i]);
    }
    u.compress(dealii::VectorOperation::insert);
    zero_entries(u, space->clamped());
    return u;
  }

  /// product += factor times that of the cells' stiffness matrices.
  void add_stiffness(const double factor, const Vector& x, Vector& product) const {
    const auto materials = whisker_sensor(1).materials.by_region();
    ElementMatrices element(*space);
    ElementMatrices::CellMatrix cell_matrix;
    for (const auto& cell : space->dofs().active_cell_iterators()) {
      const CellNodes nodes = nodes_of(*space, cell);
      element.reinit(cell);
      element.stiffness(materials.at(meshes::region_name(cell->material_id())), cell_matrix);
      Eigen::Vector<double, SolidSpace::dofs_per_cell> of_cell;
      const auto unknown = [&](const Eigen::Index i) {
        return 3 * static_cast<unsigned int>(nodes[static_cast<std::size_t>(i / 3)]) +
               static_cast<unsigned int>(i % 3);
      };
      for (Eigen::Index i = 0; i < of_cell.size(); ++i) of_cell[i] = x[unknown(i)];
      of_cell = (factor * (cell_matrix * of_cell)).eval();
      for (Eigen::Index i = 0; i < of_cell.size(); ++i) product[unknown(i)] += of_cell[i];
    }
    product.compress(dealii::VectorOperation::add);
  }

  /// tangent = stiffness * K + mass * M
  void expect_product_of(const double stiffness, const double mass) const {
    Vector x = space->make_vector(), found(x), expected(x);
    for (const auto i : x.locally_owned_elements()) x[i] = std::sin(static_cast<double>(i * i));
    x.compress(dealii::VectorOperation::insert);
    zero_entries(x, space->clamped());
    tangent->matrix().vmult(found, x);
    operators.mass->vmult(expected, x);
    expected *= mass;
    add_stiffness(stiffness, x, expected);
    zero_entries(expected, space->clamped());
    found -= expected;
    EXPECT_LT(found.linfty_norm(), 1e-14 * expected.linfty_norm());
  }

  Vector force(const Vector& u) const {
    Vector f = space->make_vector();
    operators.internal_force->add_finite(1., u, f);
    zero_entries(f, space->clamped());
    return f;
  }

  dealii::Triangulation<3> mesh;
  std::unique_ptr<SolidSpace> space;
  SolidOperators operators;
  std::unique_ptr<TangentMatrix> tangent;
};

TEST_F(CoarseWhisker, TangentAtRestIsTheStiffnessOfTheLinearModel) {
  const Vector rest = space->make_vector();
  tangent->start(0.);
  operators.internal_force->add_tangent(1., rest, rest, *tangent);
  tangent->finish(1.);
  expect_product_of(1., 0.);
}

TEST_F(CoarseWhisker, TangentCarriesTheMassAndIsMadeAnewEachTime) {
  const Vector rest = space->make_vector();
  for (int times = 0; times < 2; ++times) {
    tangent->start(3e6);
    operators.internal_force->add_tangent(0.5, rest, rest, *tangent);
    tangent->finish(0.5);
  }
  expect_product_of(0.5, 3e6);
}

// A state turned as a whole has no stress: its tangent with another's is that one's geometric part
// on top of its own.
TEST_F(CoarseWhisker, TangentTakesTheStressesOfTheOtherState) {
  const Vector rest = space->make_vector(), u = bow(1.), h = bow(0.1);
  Vector with_stress(rest), without(rest), geometric(rest), at_rest(rest);
  const auto product = [&](const Vector& at, const Vector& stressed, Vector& to) {
    tangent->start(0.);
    operators.internal_force->add_tangent(1., at, stressed, *tangent);
    tangent->finish();
    tangent->matrix().vmult(to, h);
  };
  product(u, u, with_stress);
  product(u, rest, without);
  with_stress -= without;
  product(rest, u, geometric);
  product(rest, rest, at_rest);
  geometric -= at_rest;
  EXPECT_GT(with_stress.l2_norm(), 1e-3 * without.l2_norm());
  // The parts differ by the directions of the pressure's share only.
  geometric -= with_stress;
  EXPECT_LT(geometric.l2_norm(), 0.1 * with_stress.l2_norm());
}

TEST_F(CoarseWhisker, TangentIsTheDerivativeOfTheForce) {
  const Vector u = bow(1.), h = bow(0.1);
  tangent->start(0.);
  operators.internal_force->add_tangent(1., u, u, *tangent);
  tangent->finish();
  Vector slope = space->make_vector();
  tangent->matrix().vmult(slope, h);
  const auto error = [&](const double step) {
    Vector up(u), down(u);
    up.add(step, h);
    down.add(-step, h);
    Vector difference = force(up);
    difference -= force(down);
    difference /= 2. * step;
    difference -= slope;
    return difference.l2_norm();
  };
  EXPECT_NEAR(std::log2(error(0.02) / error(0.01)), 2., 0.1);
  EXPECT_LT(error(0.01), 0.1 * slope.l2_norm());
}

TEST_F(CoarseWhisker, ForceIsTheDerivativeOfTheEnergy) {
  const Vector u = bow(1.), h = bow(0.1);
  const double slope = force(u) * h;
  const auto error = [&](const double step) {
    Vector up(u), down(u), unused = space->make_vector();
    up.add(step, h);
    down.add(-step, h);
    return std::abs((operators.internal_force->add_finite(0., up, unused) -
                     operators.internal_force->add_finite(0., down, unused)) /
                        (2. * step) -
                    slope);
  };
  EXPECT_NEAR(std::log2(error(0.02) / error(0.01)), 2., 0.1);
}

TEST_F(CoarseWhisker, SmallForcesAreThoseOfTheLinearModel) {
  Vector linear = space->make_vector();
  operators.internal_force->add(1e-9, bow(1.), linear);
  zero_entries(linear, space->clamped());
  Vector difference = force(bow(1e-9));
  difference -= linear;
  EXPECT_LT(difference.l2_norm(), 1e-6 * linear.l2_norm());
}

TEST_F(CoarseWhisker, ABodyTurnedInsideOutHasNoEnergyAndNoForce) {
  Vector f = space->make_vector();
  Vector flat = space->make_vector();
  for (const auto i : flat.locally_owned_elements()) {
    if (i % 3 == 2) flat[i] = -1.;  // m, pushed down through the clamp
  }
  flat.compress(dealii::VectorOperation::insert);
  zero_entries(flat, space->clamped());
  EXPECT_TRUE(std::isnan(operators.internal_force->add_finite(1., flat, f)));
  EXPECT_TRUE(std::isnan(f.l2_norm()));
}

}  // namespace
}  // namespace vibrissa::fem
