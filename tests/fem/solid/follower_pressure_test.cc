#include "fem/solid/follower_pressure.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fem/solid/solid_operators.h"
#include "meshes/regions.h"

namespace vibrissa::fem {
namespace {

/// A brick, skewed, all of whose surface is loaded.
class LoadedBrick : public testing::Test {
 protected:
  LoadedBrick() {
    dealii::GridGenerator::subdivided_hyper_rectangle(mesh, {2, 1, 2}, {0., 0., 0.}, {1., .7, 1.2});
    dealii::GridTools::distort_random(0.15, mesh, false, 3);
    for (const auto& cell : mesh.active_cell_iterators()) {
      cell->set_material_id(meshes::region::silicone);
      for (const auto& face : cell->face_iterators()) {
        if (!face->at_boundary()) continue;
        face->set_boundary_id(face->center()[2] < 0.2 ? meshes::boundary::clamp
                                                      : meshes::boundary::silicone_surface);
      }
    }
    space = std::make_unique<SolidSpace>(mesh);
    pressure = std::make_unique<FollowerPressure>(
        *space,
        std::set<dealii::types::boundary_id>{meshes::boundary::clamp,
                                             meshes::boundary::silicone_surface},
        p);
  }

  Vector motion(const double size, const unsigned int seed) const {
    Vector u = space->make_vector();
    for (const auto i : u.locally_owned_elements()) {
      u[i] = size * std::sin(seed + 0.37 * static_cast<double>(i * i));
    }
    u.compress(dealii::VectorOperation::insert);
    return u;
  }
  Vector force(const Vector& u) const {
    Vector f = space->make_vector();
    pressure->add_force(u, space->make_vector(), f);
    return f;
  }
  /// X + u.
  Vector position(const Vector& u) const {
    Vector x(u);
    std::map<dealii::types::global_dof_index, dealii::Point<3>> points;
    dealii::DoFTools::map_dofs_to_support_points(space->mapping(), space->dofs(), points);
    for (const auto& [i, point] : points) x[i] = u[i] + point[static_cast<unsigned int>(i % 3)];
    x.compress(dealii::VectorOperation::insert);
    return x;
  }
  /// int x . n da / 3.
  double volume(const Vector& u) const { return -(force(u) * position(u)) / (3. * p); }

  static constexpr double p = 250.;
  dealii::Triangulation<3> mesh;
  std::unique_ptr<SolidSpace> space;
  std::unique_ptr<FollowerPressure> pressure;
};

TEST_F(LoadedBrick, ForcesOnAClosedSurfaceBalanceInTheDeformedState) {
  const Vector u = motion(0.05, 1), f = force(u), x = position(u);
  std::array<double, 3> sum{}, moment{};
  for (unsigned int n = 0; n < space->n_dofs(); n += 3) {
    for (unsigned int d = 0; d < 3; ++d) {
      const unsigned int b = (d + 1) % 3, c = (d + 2) % 3;
      sum[d] += f[n + d];
      moment[d] += x[n + b] * f[n + c] - x[n + c] * f[n + b];
    }
  }
  for (unsigned int d = 0; d < 3; ++d) {
    EXPECT_NEAR(sum[d], 0., 1e-13 * f.l1_norm());
    EXPECT_NEAR(moment[d], 0., 1e-13 * f.l1_norm());
  }
}

TEST_F(LoadedBrick, DoesTheWorkOfThePressureOnTheVolume) {
  EXPECT_NEAR(volume(space->make_vector()), dealii::GridTools::volume(mesh, space->mapping()),
              1e-13);
  const Vector u = motion(0.05, 1), h = motion(1., 2);
  const double slope = -(force(u) * h) / p;
  const auto error = [&](const double step) {
    Vector up(u), down(u);
    up.add(step, h);
    down.add(-step, h);
    return std::abs((volume(up) - volume(down)) / (2. * step) - slope);
  };
  EXPECT_NEAR(std::log2(error(0.02) / error(0.01)), 2., 0.1);
}

TEST_F(LoadedBrick, TangentIsTheDerivativeOfTheForceOnAClosedSurface) {
  const auto rubber = materials::make_yeoh({3.4e5, 0., 0.}, 1.5e9, 1080., 0.);
  const auto operators = assemble_operators(*space, {{"silicone", rubber}});
  TangentMatrix tangent(*space, *operators.mass, dealii::IndexSet(space->n_dofs()));
  const Vector u = motion(0.05, 1), h = motion(1., 2);
  tangent.start(0.);
  pressure->add_tangent(2., u, space->make_vector(), tangent);
  tangent.finish();
  Vector slope = space->make_vector();
  tangent.matrix().vmult(slope, h);
  slope /= -2.;
  // The force is of second degree in u: central differences have no error of their own.
  Vector up(u), down(u);
  up.add(0.1, h);
  down.add(-0.1, h);
  Vector difference = force(up);
  difference -= force(down);
  difference /= 0.2;
  difference -= slope;
  EXPECT_LT(difference.l2_norm(), 1e-12 * slope.l2_norm());
}

}  // namespace
}  // namespace vibrissa::fem
