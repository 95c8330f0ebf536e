// Before deal.II, whose macro Assert hides a function of gmock.
#include <gmock/gmock.h>

#include "meshes/mesh_audit.h"

#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/grid_generator.h>

#include "meshes/regions.h"
#include "signals/base/error.h"

namespace vibrissa::meshes {
namespace {

using signals::UserError;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Pair;
using ::testing::ThrowsMessage;
using ::testing::UnorderedElementsAre;

const dealii::MappingQ<3> mapping(2);

/// A block of 2 x 3 x 5 m: silicone below z = 4, wire above; clamped at z = 0.
void make_block(dealii::Triangulation<3>& mesh) {
  dealii::GridGenerator::subdivided_hyper_rectangle(mesh, {2, 3, 5}, dealii::Point<3>(),
                                                    dealii::Point<3>(2., 3., 5.));
  for (const auto& cell : mesh.active_cell_iterators()) {
    const bool is_wire = cell->center()[2] > 4.;
    cell->set_material_id(is_wire ? region::wire : region::silicone);
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary())
        face->set_boundary_id(face->center()[2] == 0. ? boundary::clamp
                              : is_wire               ? boundary::wire_surface
                                                      : boundary::silicone_surface);
  }
}

TEST(Regions, NamesAndIdsBelongTogether) {
  for (const auto& [name, id] : region_ids()) EXPECT_EQ(region_name(id), name);
  for (const auto& [name, id] : boundary_ids()) EXPECT_EQ(boundary_name(id), name);
  EXPECT_THAT([] { region_name(7); },
              ThrowsMessage<UserError>(AllOf(HasSubstr("id 7"), HasSubstr("silicone (1)"))));
  EXPECT_THAT([] { boundary_name(0); },
              ThrowsMessage<UserError>(AllOf(HasSubstr("id 0"), HasSubstr("clamp (1)"))));
}

TEST(MeshAudit, MeasuresABlockExactly) {
  dealii::Triangulation<3> mesh;
  make_block(mesh);
  const MeshAudit audit = audit_mesh(mesh, mapping, {{"silicone", 1000.}, {"wire", 10.}});
  EXPECT_EQ(audit.n_cells, 30u);
  EXPECT_THAT(audit.region_volume_m3,
              UnorderedElementsAre(Pair("silicone", ::testing::DoubleNear(24., 1e-12)),
                                   Pair("wire", ::testing::DoubleNear(6., 1e-12))));
  EXPECT_THAT(audit.region_mass_kg,
              UnorderedElementsAre(Pair("silicone", ::testing::DoubleNear(24000., 1e-9)),
                                   Pair("wire", ::testing::DoubleNear(60., 1e-12))));
  EXPECT_THAT(audit.boundary_area_m2,
              UnorderedElementsAre(Pair("clamp", ::testing::DoubleNear(6., 1e-12)),
                                   Pair("silicone_surface", ::testing::DoubleNear(40., 1e-12)),
                                   Pair("wire_surface", ::testing::DoubleNear(16., 1e-12))));
  EXPECT_THAT(
      audit.interface_area_m2,
      UnorderedElementsAre(Pair(Pair("silicone", "wire"), ::testing::DoubleNear(6., 1e-12))));
  EXPECT_NEAR(audit.smallest_jacobian_ratio, 1., 1e-12);
  EXPECT_EQ(audit.sha256, mesh_sha256(mesh));
}

TEST(MeshAudit, CountsAnInterfaceOnceWhereOneSideIsRefined) {
  for (const auto refined_region : {region::silicone, region::wire}) {
    dealii::Triangulation<3> mesh;
    make_block(mesh);
    for (const auto& cell : mesh.active_cell_iterators())
      if (cell->material_id() == refined_region) cell->set_refine_flag();
    mesh.execute_coarsening_and_refinement();
    ASSERT_TRUE(mesh.has_hanging_nodes());
    const MeshAudit audit = audit_mesh(mesh, mapping);
    EXPECT_NEAR((audit.interface_area_m2.at({"silicone", "wire"})), 6., 1e-12);
    EXPECT_NEAR(audit.boundary_area_m2.at("silicone_surface"), 40., 1e-12);
  }
}

TEST(MeshAudit, GivesNoMassWithoutDensities) {
  dealii::Triangulation<3> mesh;
  make_block(mesh);
  EXPECT_TRUE(audit_mesh(mesh, mapping).region_mass_kg.empty());
}

TEST(MeshAudit, JacobianRatioOfATruncatedPyramidIsTheRatioOfItsEnds) {
  dealii::Triangulation<3> mesh;
  dealii::GridGenerator::hyper_cube(mesh, -1., 1.);
  mesh.begin_active()->set_material_id(region::wire);
  for (const auto& face : mesh.active_face_iterators()) face->set_boundary_id(boundary::clamp);
  for (unsigned int v = 4; v < 8; ++v) {
    dealii::Point<3>& top = mesh.begin_active()->vertex(v);
    top[0] *= 0.5;
    top[1] *= 0.5;
  }
  // Sections shrink linearly: det J goes with the section's area.
  EXPECT_NEAR(audit_mesh(mesh, mapping).smallest_jacobian_ratio, 0.25, 1e-12);
}

TEST(MeshAudit, RefusesAnInvertedCellWithItsCentre) {
  dealii::Triangulation<3> mesh;
  make_block(mesh);
  for (const auto& cell : mesh.active_cell_iterators())
    if (cell->center().distance(dealii::Point<3>(1.5, 2.5, 4.5)) < 0.1)
      cell->vertex(7) = dealii::Point<3>(1.2, 2.2, 4.2);
  EXPECT_THAT([&] { audit_mesh(mesh, mapping); },
              ThrowsMessage<UserError>(AllOf(HasSubstr("inverted or degenerate cell at (1.4"),
                                             HasSubstr("Jacobian determinant"))));
}

TEST(MeshAudit, RefusesAFlatCell) {
  dealii::Triangulation<3> mesh;
  make_block(mesh);
  for (const auto& cell : mesh.active_cell_iterators())
    for (const unsigned int v : cell->vertex_indices())
      if (cell->vertex(v)[2] == 5.) cell->vertex(v)[2] = 4.;
  EXPECT_THAT([&] { audit_mesh(mesh, mapping); },
              ThrowsMessage<UserError>(HasSubstr("inverted or degenerate cell")));
}

TEST(MeshAudit, RefusesACellWithoutRegionAndAnOuterFaceWithoutMark) {
  dealii::Triangulation<3> mesh;
  make_block(mesh);
  mesh.begin_active()->set_material_id(9);
  EXPECT_THAT(
      [&] { audit_mesh(mesh, mapping); },
      ThrowsMessage<UserError>(AllOf(HasSubstr("cell at (0.5, 0.5, 0.5) m"), HasSubstr("id 9"))));
  make_block(mesh = dealii::Triangulation<3>());
  mesh.begin_active()->face(4)->set_boundary_id(0);
  EXPECT_THAT([&] { audit_mesh(mesh, mapping); },
              ThrowsMessage<UserError>(
                  AllOf(HasSubstr("outer face at (0.5, 0.5, 0) m"), HasSubstr("id 0"))));
}

TEST(MeshAudit, RefusesAMeshWithoutClamp) {
  dealii::Triangulation<3> mesh;
  make_block(mesh);
  for (const auto& face : mesh.active_face_iterators())
    if (face->at_boundary()) face->set_boundary_id(boundary::wire_surface);
  EXPECT_THAT([&] { audit_mesh(mesh, mapping); }, ThrowsMessage<UserError>(HasSubstr("'clamp'")));
}

TEST(MeshAudit, RefusesARegionWithoutDensityWhenDensitiesAreGiven) {
  dealii::Triangulation<3> mesh;
  make_block(mesh);
  EXPECT_THAT(
      [&] {
        audit_mesh(mesh, mapping, {{"silicone", 1080.}});
      },
      ThrowsMessage<UserError>(HasSubstr("'wire' has no density")));
}

// Python: hashlib.sha256(b"".join(struct.pack("<q", i) for i in
//   [round(x * 1e12) for z in (0, 1) for y in (0, 1) for x_ in (0, 1) for x in (x_, y, z)]
//   + [2] + list(range(8)) + [1] * 6)).hexdigest()
TEST(MeshSha256, IsTheDigestOfTheDocumentedBytes) {
  dealii::Triangulation<3> mesh;
  dealii::GridGenerator::hyper_cube(mesh);
  mesh.begin_active()->set_material_id(region::wire);
  for (const auto& face : mesh.active_face_iterators()) face->set_boundary_id(boundary::clamp);
  EXPECT_EQ(mesh_sha256(mesh), "595c7bd6b0ef5b52aa00edd24aed6b22c676450ba4d4ad2f00af1d79f094f6ec");
}

TEST(MeshSha256, ChangesWithVerticesRegionsAndBoundaries) {
  dealii::Triangulation<3> mesh;
  make_block(mesh);
  const std::string original = mesh_sha256(mesh);
  const auto cell = mesh.begin_active();
  cell->vertex(0)[1] += 1e-11;
  EXPECT_NE(mesh_sha256(mesh), original);
  cell->vertex(0)[1] -= 1e-11;
  EXPECT_EQ(mesh_sha256(mesh), original);
  cell->set_material_id(region::wire);
  EXPECT_NE(mesh_sha256(mesh), original);
  cell->set_material_id(region::silicone);
  cell->face(4)->set_boundary_id(boundary::silicone_surface);
  EXPECT_NE(mesh_sha256(mesh), original);
}

TEST(MeshSha256, DoesNotSeeTheLastDigitOfAVertex) {
  dealii::Triangulation<3> mesh;
  make_block(mesh);
  const std::string original = mesh_sha256(mesh);
  mesh.begin_active()->vertex(7)[0] = std::nextafter(mesh.begin_active()->vertex(7)[0], 2.);
  mesh.begin_active()->vertex(0)[0] = -0.;
  EXPECT_EQ(mesh_sha256(mesh), original);
}

}  // namespace
}  // namespace vibrissa::meshes
