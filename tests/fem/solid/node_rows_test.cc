#include "fem/solid/node_rows.h"

#include <deal.II/distributed/shared_tria.h>
#include <deal.II/grid/grid_tools.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fem/sensor/modes.h"
#include "fem/solid/internal_force.h"
#include "fem/solid/solid_operators.h"
#include "meshes/sensor_mesh.h"

namespace vibrissa::fem {
namespace {

const std::map<std::string, materials::Material> nitinol = {
    {"wire", materials::make_elastic(70e9, 0.33, 6450., 0.)}};

class Wire {
 public:
  explicit Wire(dealii::Triangulation<3>& mesh) {
    meshes::make_clamped_wire_mesh(0.58e-3, 89.9e-3, 1, mesh);
    space = std::make_unique<SolidSpace>(mesh);
    operators = assemble_operators(*space, nitinol);
  }
  std::unique_ptr<SolidSpace> space;
  SolidOperators operators;
};

// The cells' forces add up without any matrix.
TEST(NodeRows, ProductIsThatOfTheCellsOneByOne) {
  dealii::Triangulation<3> mesh;
  const Wire wire(mesh);
  Vector u = wire.space->make_vector(), product(u), force(u);
  for (const auto i : u.locally_owned_elements()) u[i] = std::sin(static_cast<double>(i * i));
  u.compress(dealii::VectorOperation::insert);
  zero_entries(u, wire.space->clamped());
  wire.operators.clamped_stiffness->vmult(product, u);
  wire.operators.internal_force->add(1., u, force);
  zero_entries(force, wire.space->clamped());
  force -= product;
  EXPECT_LT(force.linfty_norm(), 1e-13 * product.linfty_norm());
}

TEST(NodeRows, MassAddsUpToThatOfTheMeshInEveryDirection) {
  dealii::Triangulation<3> mesh;
  const Wire wire(mesh);
  Vector momentum = wire.space->make_vector();
  const double mass_kg = 6450. * dealii::GridTools::volume(mesh, wire.space->mapping());
  for (unsigned int d = 0; d < 3; ++d) {
    wire.operators.mass->vmult(momentum, wire.space->translation(d));
    for (unsigned int e = 0; e < 3; ++e) {
      EXPECT_NEAR(momentum * wire.space->translation(e), d == e ? mass_kg : 0., 1e-12 * mass_kg);
    }
  }
}

// Run alone and by several processes (CMakeLists.txt): the mesh shared among all against a whole
// one for each.
TEST(NodeRows, ProcessesTogetherFindTheModesOfEachAlone) {
  dealii::Triangulation<3> whole;
  const Wire alone(whole);
  dealii::parallel::shared::Triangulation<3> shared(
      MPI_COMM_WORLD, dealii::Triangulation<3>::none, true,
      dealii::parallel::shared::Triangulation<3>::partition_zorder);
  const Wire together(shared);
  const auto expected = solve_modes(*alone.space, alone.operators, 6);
  const auto modes = solve_modes(*together.space, together.operators, 6);
  ASSERT_EQ(modes.size(), expected.size());
  for (std::size_t k = 0; k < modes.size(); ++k) {
    EXPECT_NEAR(modes[k].frequency_hz / expected[k].frequency_hz, 1., 1e-9) << k;
  }
  EXPECT_NEAR(modes[0].participation[0] / expected[0].participation[0], 1., 1e-9);
}

}  // namespace
}  // namespace vibrissa::fem
