#include "fem/internal_force.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/solid_operators.h"
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

  void expect_same_products(const Matrix& a, const Matrix& b) const {
    Vector x = space->make_vector(), ax(x), bx(x);
    for (const auto i : x.locally_owned_elements()) x[i] = std::sin(static_cast<double>(i * i));
    x.compress(dealii::VectorOperation::insert);
    a.vmult(ax, x);
    b.vmult(bx, x);
    ax -= bx;
    EXPECT_LT(ax.linfty_norm(), 1e-14 * bx.linfty_norm());
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
  expect_same_products(tangent->matrix(), *operators.clamped_stiffness);
}

TEST_F(CoarseWhisker, TangentCarriesTheMassAndIsMadeAnewEachTime) {
  const Vector rest = space->make_vector();
  for (int times = 0; times < 2; ++times) {
    tangent->start(3e6);
    operators.internal_force->add_tangent(0.5, rest, rest, *tangent);
    tangent->finish(0.5);
  }
  expect_same_products(tangent->matrix(),
                       *combine(0.5, *operators.clamped_stiffness, 3e6, *operators.clamped_mass));
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
