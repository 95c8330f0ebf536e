#include "fem/solid/element_matrices.h"

#include <deal.II/grid/grid_generator.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "fem/factors/cholesky_solver.h"
#include "fem/solid/solid_operators.h"
#include "meshes/regions.h"

namespace vibrissa::fem {
namespace {

/// One skewed cell, held at its lower face.
class OneCell : public testing::Test {
 protected:
  OneCell() {
    const std::vector<dealii::Point<3>> vertices{{0, 0, 0},     {1.1, .1, .05}, {-.1, .9, 0},
                                                 {1, 1.2, -.1}, {.1, 0, 1},     {1.3, 0, 1.1},
                                                 {0, 1.1, .9},  {1, 1, 1.2}};
    std::vector<dealii::CellData<3>> cells(1);
    for (unsigned int v = 0; v < 8; ++v) cells[0].vertices[v] = v;
    mesh.create_triangulation(vertices, cells, {});
    mesh.begin_active()->set_material_id(meshes::region::silicone);
    mesh.begin_active()->face(4)->set_boundary_id(meshes::boundary::clamp);
    space = std::make_unique<SolidSpace>(mesh);
    element = std::make_unique<ElementMatrices>(*space);
    element->reinit(mesh.begin_active());
    element->stiffness(rubber, stiffness);
  }

  Eigen::VectorXd nodal(const Vector& global) const {
    std::vector<dealii::types::global_dof_index> dofs(SolidSpace::dofs_per_cell);
    space->dofs().begin_active()->get_dof_indices(dofs);
    Eigen::VectorXd local(SolidSpace::dofs_per_cell);
    for (unsigned int n = 0; n < SolidSpace::nodes_per_cell; ++n) {
      for (unsigned int c = 0; c < 3; ++c) local[3 * n + c] = global[dofs[space->cell_dof(n, c)]];
    }
    return local;
  }

  dealii::Triangulation<3> mesh;
  std::unique_ptr<SolidSpace> space;
  std::unique_ptr<ElementMatrices> element;
  ElementMatrices::CellMatrix stiffness;
  const materials::Material rubber =
      materials::make_yeoh({3.4e5, 1.7152e5, 1.32e8}, 1.5e9, 1080., 0.);
};

TEST_F(OneCell, RigidMotionsStoreNoEnergy) {
  for (unsigned int d = 0; d < 3; ++d) {
    for (const auto& motion : {space->translation(d), space->rotation(d)}) {
      const Eigen::VectorXd u = nodal(motion);
      EXPECT_LT((stiffness * u).norm(), 1e-12 * stiffness.norm() * u.norm());
    }
  }
}

TEST_F(OneCell, HasNoOtherMotionWithoutEnergy) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(stiffness);
  const auto values = eigen.eigenvalues();
  EXPECT_LT(values[5], 1e-9 * values[80]);
  EXPECT_GT(values[6], 1e-6 * values[80]);
}

TEST_F(OneCell, SimpleShearStoresTheEnergyOfTheLaw) {
  const double e = 1e-3;
  // Rotation about y moves x by z; a shear x by z has energy mu/2 g^2 V and no volume change.
  const Eigen::VectorXd rotation = nodal(space->rotation(1));
  Eigen::VectorXd shear = Eigen::VectorXd::Zero(rotation.size());
  for (Eigen::Index n = 0; n < rotation.size(); n += 3) shear[n] = e * rotation[n];
  ElementMatrices::NodeMatrix mass;
  element->mass(1., mass);
  const double volume = mass.sum();
  const double energy = 0.5 * shear.dot(stiffness * shear);
  EXPECT_NEAR(energy, 0.5 * rubber.shear_modulus_at_rest() * e * e * volume, 1e-9 * energy);
}

TEST_F(OneCell, MassIsDensityTimesVolumeWhateverTheSkew) {
  ElementMatrices::NodeMatrix once, scaled;
  element->mass(1., once);
  element->mass(1080., scaled);
  double volume = 0.;
  const dealii::QGauss<3> quadrature(4);
  dealii::FEValues<3> values(space->mapping(), space->scalar_element(), quadrature,
                             dealii::update_JxW_values);
  values.reinit(mesh.begin_active());
  for (unsigned int q = 0; q < quadrature.size(); ++q) volume += values.JxW(q);
  EXPECT_NEAR(once.sum(), volume, 1e-12 * volume);
  EXPECT_NEAR(scaled.sum(), 1080. * volume, 1e-9 * volume);
}

// A bar in pure bending: plain Q2 with K/mu = 2200 locks, the projected form gives the closed form.
TEST(ElementMatrices, DoNotLockInBendingOfARubberBar) {
  dealii::Triangulation<3> mesh;
  dealii::GridGenerator::subdivided_hyper_rectangle(mesh, {1, 1, 8}, {-0.5e-3, -0.5e-3, 0.},
                                                    {0.5e-3, 0.5e-3, 16e-3});
  for (const auto& cell : mesh.active_cell_iterators()) {
    cell->set_material_id(meshes::region::silicone);
    for (const auto& face : cell->face_iterators()) {
      if (face->at_boundary() && face->center()[2] < 1e-9) {
        face->set_boundary_id(meshes::boundary::clamp);
      }
    }
  }
  const SolidSpace space(mesh);
  const auto rubber = materials::make_yeoh({3.4e5, 0., 0.}, 1.5e9, 1080., 0.);
  const auto operators = assemble_operators(space, {{"silicone", rubber}});
  Vector load = space.make_vector();
  operators.mass->vmult(load, space.translation(0));
  zero_entries(load, space.clamped());
  Vector u = space.make_vector();
  CholeskySolver(*operators.clamped_stiffness).solve(load, u);
  // Euler-Bernoulli under uniform body force of 1 m/s^2: q L^4 / (8 E I), shear adds
  // q L^2 / (2 k G A) with k = 5/6.
  const double q = 1080. * 1e-6, length = 16e-3, e = rubber.youngs_modulus_at_rest();
  const double bending = q * std::pow(length, 4) / (8. * e * 1e-12 / 12.);
  const double shear =
      q * length * length / (2. * (5. / 6.) * rubber.shear_modulus_at_rest() * 1e-6);
  EXPECT_NEAR(u.linfty_norm(), bending + shear, 0.015 * bending);
}

}  // namespace
}  // namespace vibrissa::fem
