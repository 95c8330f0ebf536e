// Before deal.II, whose macro Assert hides a function of gmock.
#include <gmock/gmock.h>

#include "meshes/sensor_mesh.h"

#include <deal.II/fe/mapping_q.h>

#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "meshes/mesh_audit.h"
#include "meshes/regions.h"
#include "signals/base/error.h"
#include "tests/meshes/flow_sensor.h"

namespace vibrissa::meshes {
namespace {

using signals::UserError;
using std::numbers::pi;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

SensorGeometry whisker_sensor() {
  return {};
}

SensorGeometry plate_sensor() {
  SensorGeometry geometry;
  geometry.fin = FinShape::plate;
  geometry.free_length = 8.5e-3;
  geometry.fin_thickness = 1.2e-3;
  geometry.fin_top_width = 16e-3;
  geometry.fin_bottom_width = 6e-3;
  return geometry;
}

MeshAudit audit_of(const SensorGeometry& geometry, const unsigned int resolution,
                   const unsigned int mapping_degree = 2) {
  dealii::Triangulation<3> mesh;
  make_sensor_mesh(geometry, resolution, mesh);
  return audit_mesh(mesh, dealii::MappingQ<3>(mapping_degree));
}

double circle_area(const double diameter) {
  return pi / 4. * diameter * diameter;
}

/// Area and length of the closed curve that MappingQ(2) makes of a circle: 4n parabolas with ends
/// and vertex on the circle; segment area 2/3 chord * rise, arc length in closed form.
double meshed_circle_area(const double diameter, const unsigned int n) {
  const double r = 0.5 * diameter, a = pi / (4. * n);
  return 4. * n * r * r * std::sin(a) * (std::cos(a) + 4. / 3. * (1. - std::cos(a)));
}

double meshed_circle_length(const double diameter, const unsigned int n) {
  const double r = 0.5 * diameter, a = pi / (4. * n);
  const double chord = 2. * r * std::sin(a), rise = r * (1. - std::cos(a));
  const double root = std::hypot(chord, 4. * rise);
  return 4. * n * (0.5 * root + chord * chord / (8. * rise) * std::log((4. * rise + root) / chord));
}

/// Section of a fin without the hole for the wire.
double fin_section(const SensorGeometry& g, const double width) {
  const double t = g.fin_thickness;
  return g.fin == FinShape::cross ? t * t + 2. * t * (width - t) : t * width;
}

/// Blades' sides, ends and the free sides of the square, without top and bottom.
double fin_side_area(const SensorGeometry& g) {
  const double t = g.fin_thickness, n_wings = g.fin == FinShape::cross ? 4. : 2.;
  const double mean_width = 0.5 * (g.fin_top_width + g.fin_bottom_width);
  const double slant = std::hypot(g.fin_height, 0.5 * (g.fin_top_width - g.fin_bottom_width));
  return n_wings * (g.fin_height * (mean_width - t) + t * slant) +
         (4. - n_wings) * t * g.fin_height;
}

TEST(SensorMesh, VolumesAreThoseOfCylindersWithParabolicEdges) {
  for (const SensorGeometry& g : {whisker_sensor(), flow_sensor(), plate_sensor()})
    for (const unsigned int n : {1u, 2u, 3u}) {
      const MeshAudit audit = audit_of(g, n);
      const double wire_section = meshed_circle_area(g.wire_diameter, n);
      const double wire = wire_section * (g.tip_height() - g.base_height + g.embedded_length);
      const double silicone =
          meshed_circle_area(g.base_diameter, n) * g.base_height - wire_section * g.embedded_length;
      EXPECT_NEAR(audit.region_volume_m3.at("wire") / wire, 1., 1e-12);
      EXPECT_NEAR(audit.region_volume_m3.at("silicone") / silicone, 1., 1e-12);
    }
}

TEST(SensorMesh, FinIsATaperedCrossOrPlateAroundTheWire) {
  for (const SensorGeometry& g : {flow_sensor(), plate_sensor()})
    for (const unsigned int n : {1u, 2u, 3u}) {
      const double mean_section = fin_section(g, 0.5 * (g.fin_top_width + g.fin_bottom_width));
      const double volume = g.fin_height * (mean_section - meshed_circle_area(g.wire_diameter, n));
      EXPECT_NEAR(audit_of(g, n).region_volume_m3.at("fin") / volume, 1., 1e-12);
    }
}

TEST(SensorMesh, VolumesConvergeWithOrderFourAndLieWithinAThousandthAtResolutionTwo) {
  const SensorGeometry g = whisker_sensor();
  const double wire = circle_area(g.wire_diameter) * (g.free_length + g.embedded_length);
  const double silicone = circle_area(g.base_diameter) * g.base_height -
                          circle_area(g.wire_diameter) * g.embedded_length;
  const MeshAudit coarse = audit_of(g, 2), fine = audit_of(g, 4);
  for (const auto& [name, exact] : {std::pair("wire", wire), std::pair("silicone", silicone)}) {
    const double coarse_error = coarse.region_volume_m3.at(name) / exact - 1.;
    const double fine_error = fine.region_volume_m3.at(name) / exact - 1.;
    EXPECT_LT(std::abs(coarse_error), 1e-3);
    EXPECT_NEAR(std::log2(coarse_error / fine_error), 4., 0.15) << name;
  }
}

TEST(SensorMesh, SurfacesAndInterfacesHaveTheAreasOfTheirCylinders) {
  const unsigned int n = 2;
  const double tolerance = 1e-6;  // of Gauss quadrature of the parabolas' arc length
  for (const SensorGeometry& g : {whisker_sensor(), flow_sensor(), plate_sensor()}) {
    const MeshAudit audit = audit_of(g, n);
    const double wire_section = meshed_circle_area(g.wire_diameter, n);
    const double base_section = meshed_circle_area(g.base_diameter, n);
    const double wire_edge = meshed_circle_length(g.wire_diameter, n);
    const double base_edge = meshed_circle_length(g.base_diameter, n);
    EXPECT_NEAR(audit.boundary_area_m2.at("clamp") / base_section, 1., tolerance);
    EXPECT_NEAR(audit.boundary_area_m2.at("silicone_surface") /
                    (base_edge * g.base_height + base_section - wire_section),
                1., tolerance);
    EXPECT_NEAR(
        audit.boundary_area_m2.at("wire_surface") / (wire_edge * g.free_length + wire_section), 1.,
        tolerance);
    EXPECT_NEAR(audit.interface_area_m2.at({"silicone", "wire"}) /
                    (wire_edge * g.embedded_length + wire_section),
                1., tolerance);
    if (g.fin == FinShape::none) continue;
    const double ends =
        fin_section(g, g.fin_top_width) + fin_section(g, g.fin_bottom_width) - 2. * wire_section;
    EXPECT_NEAR(audit.boundary_area_m2.at("fin_surface") / (fin_side_area(g) + ends), 1.,
                tolerance);
    EXPECT_NEAR(audit.interface_area_m2.at({"fin", "wire"}) / (wire_edge * g.fin_height), 1.,
                tolerance);
    EXPECT_FALSE(audit.interface_area_m2.contains({"fin", "silicone"}));
  }
}

TEST(SensorMesh, InterfaceOfWireAndSiliconeIsThatOfARoundWire) {
  const SensorGeometry g = whisker_sensor();
  const double exact = pi * g.wire_diameter * g.embedded_length + circle_area(g.wire_diameter);
  EXPECT_NEAR(audit_of(g, 4).interface_area_m2.at({"silicone", "wire"}) / exact, 1., 1e-4);
}

TEST(SensorMesh, MassIsDensityTimesVolume) {
  const SensorGeometry g = flow_sensor();
  dealii::Triangulation<3> mesh;
  make_sensor_mesh(g, 3, mesh);
  const MeshAudit audit = audit_mesh(mesh, dealii::MappingQ<3>(2),
                                     {{"silicone", 1080.}, {"wire", 6450.}, {"fin", 1230.}});
  const double wire_length = g.embedded_length + g.free_length + g.fin_height;
  const double wire = circle_area(g.wire_diameter) * wire_length;
  const double silicone = circle_area(g.base_diameter) * g.base_height -
                          circle_area(g.wire_diameter) * g.embedded_length;
  const double mean_width = 0.5 * (g.fin_top_width + g.fin_bottom_width);
  const double fin = g.fin_height * (fin_section(g, mean_width) - circle_area(g.wire_diameter));
  EXPECT_NEAR(audit.region_mass_kg.at("silicone") / (1080. * silicone), 1., 2e-4);
  EXPECT_NEAR(audit.region_mass_kg.at("wire") / (6450. * wire), 1., 2e-4);
  EXPECT_NEAR(audit.region_mass_kg.at("fin") / (1230. * fin), 1., 2e-4);
}

/// V - E + F - C = 1 for a solid without holes; a crack or an unmatched face would change it.
TEST(SensorMesh, IsOneConformingSolid) {
  for (const SensorGeometry& g : {whisker_sensor(), flow_sensor(), plate_sensor()})
    for (const unsigned int n : {1u, 2u, 3u, 4u}) {
      dealii::Triangulation<3> mesh;
      make_sensor_mesh(g, n, mesh);
      EXPECT_EQ(mesh.n_levels(), 1u);
      EXPECT_FALSE(mesh.has_hanging_nodes());
      const auto count = [](const unsigned int number) { return static_cast<int>(number); };
      EXPECT_EQ(count(mesh.n_used_vertices()) - count(mesh.n_active_lines()) +
                    count(mesh.n_active_faces()) - count(mesh.n_active_cells()),
                1);
      std::set<std::array<long, 3>> places;
      for (const auto& v : mesh.get_vertices())
        places.insert({std::lround(v[0] * 1e9), std::lround(v[1] * 1e9), std::lround(v[2] * 1e9)});
      EXPECT_EQ(places.size(), mesh.n_used_vertices()) << "two vertices within a nanometre";
    }
}

/// Everything a user may ask for at its edges: thinnest walls, fattest wire, reversed taper, no
/// silicone below the wire, largest and smallest parts together.
std::vector<SensorGeometry> odd_geometries() {
  std::vector<SensorGeometry> all = {whisker_sensor(), flow_sensor(), plate_sensor()};
  SensorGeometry g = flow_sensor();
  g.fin_thickness = 1.1 * g.wire_diameter;
  g.fin_bottom_width = g.fin_thickness + 2e-5;
  all.push_back(g);
  g = flow_sensor();
  g.fin_top_width = 3e-3;
  g.fin_bottom_width = 40e-3;
  all.push_back(g);
  g = plate_sensor();
  g.fin_thickness = 5e-3;
  g.fin_height = 1e-3;
  all.push_back(g);
  g = whisker_sensor();
  g.base_diameter = g.wire_diameter + 2e-5;
  all.push_back(g);
  g.base_diameter = 1.;
  g.wire_diameter = 1e-5;
  g.free_length = 1.;
  all.push_back(g);
  g = whisker_sensor();
  g.embedded_length = g.base_height;
  all.push_back(g);
  g.base_height = 1e-4;
  g.embedded_length = 1e-5;
  g.free_length = 1e-5;
  all.push_back(g);
  return all;
}

TEST(SensorMesh, HasNoInvertedCellForAnyGeometryAndResolution) {
  const auto geometries = odd_geometries();
  for (unsigned int i = 0; i < geometries.size(); ++i)
    for (unsigned int n = 1; n <= 4; ++n)
      EXPECT_GT(audit_of(geometries[i], n).smallest_jacobian_ratio, 1e-3)
          << "geometry " << i << ", resolution " << n;
}

TEST(SensorMesh, CellsOfTheStudysSensorsAreWellShaped) {
  for (const SensorGeometry& g : {whisker_sensor(), flow_sensor(), plate_sensor()}) {
    EXPECT_GT(audit_of(g, 1).smallest_jacobian_ratio, 0.2);
    EXPECT_GT(audit_of(g, 2).smallest_jacobian_ratio, 0.3);
  }
}

TEST(SensorMesh, WireThatReachesTheSupportIsClampedThere) {
  SensorGeometry g = whisker_sensor();
  g.embedded_length = g.base_height;
  const MeshAudit audit = audit_of(g, 2);
  EXPECT_NEAR(audit.boundary_area_m2.at("clamp") / meshed_circle_area(g.base_diameter, 2), 1.,
              1e-12);
  const double side = meshed_circle_length(g.wire_diameter, 2) * g.embedded_length;
  EXPECT_NEAR(audit.interface_area_m2.at({"silicone", "wire"}) / side, 1., 1e-6);
}

TEST(SensorMesh, VerticesOfAResolutionAreAmongThoseOfTwiceTheResolution) {
  using Place = std::array<long, 3>;
  const auto places = [](const SensorGeometry& g, const unsigned int n) {
    dealii::Triangulation<3> mesh;
    make_sensor_mesh(g, n, mesh);
    std::set<Place> result;
    for (const auto& v : mesh.get_vertices())
      result.insert({std::lround(v[0] * 1e10), std::lround(v[1] * 1e10), std::lround(v[2] * 1e10)});
    return result;
  };
  for (const SensorGeometry& g : {whisker_sensor(), flow_sensor(), plate_sensor()})
    for (const unsigned int n : {1u, 2u}) {
      const auto coarse = places(g, n), fine = places(g, 2 * n);
      EXPECT_TRUE(std::includes(fine.begin(), fine.end(), coarse.begin(), coarse.end()));
    }
}

TEST(SensorMesh, StaysRoundWhenItIsRefined) {
  const SensorGeometry g = flow_sensor();
  dealii::Triangulation<3> mesh;
  make_sensor_mesh(g, 1, mesh);
  mesh.refine_global();
  const MeshAudit audit = audit_mesh(mesh, dealii::MappingQ<3>(2));
  const double wire_length = g.tip_height() - g.base_height + g.embedded_length;
  EXPECT_NEAR(
      audit.region_volume_m3.at("wire") / (meshed_circle_area(g.wire_diameter, 2) * wire_length),
      1., 1e-12);
  EXPECT_NEAR(audit.boundary_area_m2.at("clamp") / meshed_circle_area(g.base_diameter, 2), 1.,
              1e-12);
}

TEST(SensorMesh, CellCountGrowsWithTheCubeOfTheResolution) {
  const unsigned int flow = audit_of(flow_sensor(), 1).n_cells;
  const unsigned int whisker = audit_of(whisker_sensor(), 1).n_cells;
  for (const unsigned int n : {2u, 3u}) {
    EXPECT_EQ(audit_of(flow_sensor(), n).n_cells, flow * n * n * n);
    EXPECT_EQ(audit_of(whisker_sensor(), n).n_cells, whisker * n * n * n);
  }
  EXPECT_EQ(8 * flow, 808u);
}

TEST(SensorMesh, LooksTheSameAfterAQuarterTurn) {
  dealii::Triangulation<3> mesh;
  make_sensor_mesh(flow_sensor(), 3, mesh);
  std::set<std::array<double, 3>> places;
  for (const auto& v : mesh.get_vertices()) places.insert({v[0] + 0., v[1] + 0., v[2]});
  for (const auto& [x, y, z] : places) EXPECT_TRUE(places.contains({-y + 0., x, z}));
}

TEST(SensorMesh, RunsFromTheSupportToTheTipWithTheBladesAlongTheirAxes) {
  for (const SensorGeometry& g : {whisker_sensor(), flow_sensor(), plate_sensor()}) {
    dealii::Triangulation<3> mesh;
    make_sensor_mesh(g, 2, mesh);
    double lowest = 1., highest = 0., top_x = 0., top_y = 0., bottom_y = 0.;
    for (const auto& v : mesh.get_vertices()) {
      lowest = std::min(lowest, v[2]);
      highest = std::max(highest, v[2]);
    }
    for (const auto& v : mesh.get_vertices()) {
      if (v[2] == highest) top_x = std::max(top_x, v[0]), top_y = std::max(top_y, v[1]);
      if (std::abs(v[2] - g.base_height - g.free_length) < 1e-12)
        bottom_y = std::max(bottom_y, v[1]);
    }
    EXPECT_EQ(lowest, 0.);
    EXPECT_NEAR(highest, g.tip_height(), 1e-15);
    if (g.fin == FinShape::none) continue;
    EXPECT_NEAR(top_y, 0.5 * g.fin_top_width, 1e-15);
    EXPECT_NEAR(bottom_y, 0.5 * g.fin_bottom_width, 1e-15);
    EXPECT_NEAR(top_x, 0.5 * (g.fin == FinShape::cross ? g.fin_top_width : g.fin_thickness), 1e-15);
  }
}

TEST(SensorMesh, HashIsTheSameForTheSameSensorAndAnotherForAnother) {
  const SensorGeometry g = flow_sensor();
  EXPECT_EQ(audit_of(g, 2).sha256, audit_of(g, 2).sha256);
  EXPECT_NE(audit_of(g, 2).sha256, audit_of(g, 3).sha256);
  SensorGeometry longer = g;
  longer.free_length += 1e-9;
  EXPECT_NE(audit_of(g, 2).sha256, audit_of(longer, 2).sha256);
}

TEST(SensorMesh, ReplacesTheMeshItIsGiven) {
  dealii::Triangulation<3> mesh;
  make_sensor_mesh(flow_sensor(), 2, mesh);
  make_sensor_mesh(whisker_sensor(), 1, mesh);
  EXPECT_EQ(audit_mesh(mesh, dealii::MappingQ<3>(2)).sha256, audit_of(whisker_sensor(), 1).sha256);
}

TEST(SensorMesh, RefusesImpossibleGeometryAndResolution) {
  dealii::Triangulation<3> mesh;
  SensorGeometry g = whisker_sensor();
  EXPECT_THAT([&] { make_sensor_mesh(g, 0, mesh); },
              ThrowsMessage<UserError>(HasSubstr("mesh resolution 0 is outside 1 ... 16")));
  EXPECT_THAT([&] { make_sensor_mesh(g, 17, mesh); },
              ThrowsMessage<UserError>(HasSubstr("mesh resolution 17 is outside")));
  g.embedded_length = 9e-3;
  EXPECT_THAT([&] { make_sensor_mesh(g, 1, mesh); },
              ThrowsMessage<UserError>(HasSubstr("'Embedded length'")));
}

TEST(ClampedWireMesh, IsARoundRodClampedAtItsFoot) {
  const double d = 0.58e-3, length = 90e-3;
  for (const unsigned int n : {1u, 2u, 3u}) {
    dealii::Triangulation<3> mesh;
    make_clamped_wire_mesh(d, length, n, mesh);
    const MeshAudit audit = audit_mesh(mesh, dealii::MappingQ<3>(2));
    const double section = meshed_circle_area(d, n);
    ASSERT_EQ(audit.region_volume_m3.size(), 1u);
    EXPECT_NEAR(audit.region_volume_m3.at("wire") / (section * length), 1., 1e-12);
    EXPECT_NEAR(audit.boundary_area_m2.at("clamp") / section, 1., 1e-12);
    EXPECT_NEAR(
        audit.boundary_area_m2.at("wire_surface") / (meshed_circle_length(d, n) * length + section),
        1., 1e-4);
    EXPECT_TRUE(audit.interface_area_m2.empty());
  }
}

TEST(ClampedWireMesh, RefusesLengthsThatAreNotPositive) {
  dealii::Triangulation<3> mesh;
  EXPECT_THAT([&] { make_clamped_wire_mesh(0., 90e-3, 1, mesh); },
              ThrowsMessage<UserError>(AllOf(HasSubstr("diameter 0 m"), HasSubstr("0.09 m"))));
  EXPECT_THROW(make_clamped_wire_mesh(1e-3, -1., 1, mesh), UserError);
  EXPECT_THROW(make_clamped_wire_mesh(1e-3, std::nan(""), 1, mesh), UserError);
  EXPECT_THROW(make_clamped_wire_mesh(1e-3, 1., 0, mesh), UserError);
}

}  // namespace
}  // namespace vibrissa::meshes
