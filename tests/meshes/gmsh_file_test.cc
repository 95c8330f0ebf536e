// Before deal.II, whose macro Assert hides a function of gmock.
#include <gmock/gmock.h>

#include "meshes/gmsh_file.h"

#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/tria.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "meshes/mesh_audit.h"
#include "meshes/regions.h"
#include "meshes/sensor_mesh.h"
#include "signals/base/error.h"

namespace vibrissa::meshes {
namespace {

using signals::UserError;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const dealii::MappingQ<3> flat_mapping(1);

std::filesystem::path data_file(const std::string& name) {
  return std::filesystem::path(VIBRISSA_SOURCE_DIR) / "tests/meshes/data" / name;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

class GmshFile : public ::testing::Test {
 protected:
  ~GmshFile() override { std::filesystem::remove(file_); }

  void read(const std::string& text) {
    std::ofstream(file_) << text;
    read_gmsh_mesh(file_, mesh_);
  }

  std::string complaint_about(const std::string& text) {
    try {
      read(text);
    } catch (const UserError& error) {
      return error.what();
    }
    return "no complaint";
  }

  const std::filesystem::path file_ =
      std::filesystem::temp_directory_path() /
      ("vibrissa_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
       ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".msh");
  dealii::Triangulation<3> mesh_;
};

/// Two unit cubes, scaled to a millimetre: silicone below, wire above.
struct TwoCubes {
  std::string version = "2.2 0 8";
  std::string names =
      "5\n3 1 \"silicone\"\n3 2 \"wire\"\n2 1 \"clamp\"\n2 2 \"silicone_surface\"\n"
      "2 3 \"wire_surface\"\n";
  double scale = 1e-3;
  double lowest = 0.;
  std::vector<std::string> elements = {"5 2 1 1 1 2 3 4 5 6 7 8", "5 2 2 2 5 6 7 8 9 10 11 12",
                                       "3 2 1 1 1 2 3 4",         "3 2 2 2 1 2 6 5",
                                       "3 2 2 2 2 3 7 6",         "3 2 2 2 3 4 8 7",
                                       "3 2 2 2 4 1 5 8",         "3 2 3 3 5 6 10 9",
                                       "3 2 3 3 6 7 11 10",       "3 2 3 3 7 8 12 11",
                                       "3 2 3 3 8 5 9 12",        "3 2 3 3 9 10 11 12"};

  std::string text() const {
    std::ostringstream out;
    out << "$MeshFormat\n" << version << "\n$EndMeshFormat\n";
    if (!names.empty()) out << "$PhysicalNames\n" << names << "$EndPhysicalNames\n";
    out << "$Nodes\n12\n";
    const std::array<std::array<int, 2>, 4> corners = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (int i = 0; i < 12; ++i)
      out << i + 1 << ' ' << scale * corners[i % 4][0] << ' ' << scale * corners[i % 4][1] << ' '
          << scale * (lowest + i / 4) << '\n';
    out << "$EndNodes\n$Elements\n" << elements.size() << '\n';
    for (unsigned int i = 0; i < elements.size(); ++i) out << i + 1 << ' ' << elements[i] << '\n';
    out << "$EndElements\n";
    return out.str();
  }
};

/// What Gmsh 4.8.4 wrote, in both formats: data/two_bodies.geo gives the dimensions.
TEST_F(GmshFile, OfGmshIsReadWithRegionsAndBoundariesByName) {
  for (const char* const name : {"two_bodies_22.msh", "two_bodies_41.msh"}) {
    read_gmsh_mesh(data_file(name), mesh_);
    const MeshAudit audit = audit_mesh(mesh_, flat_mapping);
    EXPECT_EQ(audit.n_cells, 24u);
    EXPECT_NEAR(audit.region_volume_m3.at("silicone"), 2e-9, 1e-20);
    EXPECT_NEAR(audit.region_volume_m3.at("wire"), 2e-9, 1e-20);
    EXPECT_NEAR(audit.boundary_area_m2.at("clamp"), 2e-6, 1e-17);
    EXPECT_NEAR(audit.boundary_area_m2.at("silicone_surface"), 7e-6, 1e-17);
    EXPECT_NEAR(audit.boundary_area_m2.at("wire_surface"), 9e-6, 1e-17);
    EXPECT_NEAR((audit.interface_area_m2.at({"silicone", "wire"})), 1e-6, 1e-17);
  }
}

/// deal.II's own reader keeps Gmsh's tags: wire 1 and silicone 2 in data/two_bodies_41.msh.
TEST_F(GmshFile, AgreesWithTheReaderOfDealii) {
  dealii::Triangulation<3> other;
  dealii::GridIn<3> reader(other);
  std::ifstream stream(data_file("two_bodies_41.msh"));
  reader.read_msh(stream);
  read_gmsh_mesh(data_file("two_bodies_41.msh"), mesh_);
  ASSERT_EQ(mesh_.n_active_cells(), other.n_active_cells());
  const std::map<unsigned int, unsigned int> region_of_tag = {{1, region::wire},
                                                              {2, region::silicone}};
  for (const auto& cell : mesh_.active_cell_iterators()) {
    unsigned int n_same = 0;
    for (const auto& twin : other.active_cell_iterators())
      if (cell->center().distance(twin->center()) < 1e-12) {
        ++n_same;
        EXPECT_EQ(cell->material_id(), region_of_tag.at(twin->material_id()));
      }
    EXPECT_EQ(n_same, 1u);
  }
}

TEST_F(GmshFile, OfEitherFormatGivesTheSameMesh) {
  dealii::Triangulation<3> other;
  read_gmsh_mesh(data_file("two_bodies_22.msh"), mesh_);
  read_gmsh_mesh(data_file("two_bodies_41.msh"), other);
  const MeshAudit a = audit_mesh(mesh_, flat_mapping), b = audit_mesh(other, flat_mapping);
  EXPECT_EQ(a.boundary_area_m2, b.boundary_area_m2);
  EXPECT_EQ(a.region_volume_m3, b.region_volume_m3);
}

/// Writes a mesh in format 2.2, with tags that differ from our ids.
std::string msh_22_text(const dealii::Triangulation<3>& mesh) {
  std::ostringstream out;
  out.precision(17);
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n"
      << region_ids().size() + boundary_ids().size() << '\n';
  for (const auto& [name, id] : region_ids()) out << "3 " << 20 + id << " \"" << name << "\"\n";
  for (const auto& [name, id] : boundary_ids()) out << "2 " << 30 + id << " \"" << name << "\"\n";
  out << "$EndPhysicalNames\n$Nodes\n" << mesh.n_vertices() << '\n';
  for (unsigned int v = 0; v < mesh.n_vertices(); ++v)
    out << v + 1 << ' ' << mesh.get_vertices()[v] << '\n';
  std::ostringstream elements;
  unsigned int n_elements = 0;
  for (const auto& cell : mesh.active_cell_iterators()) {
    elements << ++n_elements << " 5 2 " << 20 + cell->material_id() << " 1";
    for (const unsigned int v : {0, 1, 3, 2, 4, 5, 7, 6})
      elements << ' ' << cell->vertex_index(v) + 1;
    elements << '\n';
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary()) {
        elements << ++n_elements << " 3 2 " << 30 + face->boundary_id() << " 1";
        for (const unsigned int v : {0, 1, 3, 2}) elements << ' ' << face->vertex_index(v) + 1;
        elements << '\n';
      }
  }
  out << "$EndNodes\n$Elements\n" << n_elements << '\n' << elements.str() << "$EndElements\n";
  return out.str();
}

TEST_F(GmshFile, OfAFlowSensorHasTheSameAuditAsTheSensorItself) {
  SensorGeometry geometry;
  geometry.fin = FinShape::cross;
  dealii::Triangulation<3> original;
  make_sensor_mesh(geometry, 2, original);
  read(msh_22_text(original));
  const MeshAudit before = audit_mesh(original, flat_mapping),
                  after = audit_mesh(mesh_, flat_mapping);
  EXPECT_EQ(before.n_cells, after.n_cells);
  const auto expect_same = [](const auto& a, const auto& b) {
    ASSERT_EQ(a.size(), b.size());
    for (const auto& [key, value] : a) EXPECT_NEAR(b.at(key) / value, 1., 1e-12);
  };
  expect_same(before.region_volume_m3, after.region_volume_m3);
  expect_same(before.boundary_area_m2, after.boundary_area_m2);
  expect_same(before.interface_area_m2, after.interface_area_m2);
}

TEST_F(GmshFile, MayHaveLinesPointsOtherSectionsAndUnusedNodes) {
  TwoCubes cubes;
  cubes.elements.push_back("15 2 0 1 1");
  cubes.elements.push_back("1 2 0 1 1 2");
  std::string text = cubes.text() + "$Periodic\n0\n$EndPeriodic\n";
  text.replace(text.find("$Nodes\n12\n"), 10, "$Nodes\n13\n99 0 0 1e-3\n");
  read(text);
  EXPECT_EQ(mesh_.n_active_cells(), 2u);
  EXPECT_EQ(mesh_.n_used_vertices(), 12u);
}

TEST_F(GmshFile, MayHoldHexahedraOfNegativeOrientation) {
  TwoCubes cubes;
  cubes.elements[0] = "5 2 1 1 5 6 7 8 1 2 3 4";
  read(cubes.text());
  EXPECT_NEAR(audit_mesh(mesh_, flat_mapping).region_volume_m3.at("silicone"), 1e-9, 1e-20);
}

TEST_F(GmshFile, ThatIsMissingIsNamed) {
  EXPECT_THAT([&] { read_gmsh_mesh("no/such/file.msh", mesh_); },
              ThrowsMessage<UserError>(HasSubstr("no/such/file.msh: cannot open")));
  EXPECT_THAT([&] { read_gmsh_mesh(std::filesystem::temp_directory_path(), mesh_); },
              ThrowsMessage<UserError>(HasSubstr("cannot open")));
}

TEST_F(GmshFile, OfAnotherFormatIsRefused) {
  EXPECT_THAT(complaint_about(""), HasSubstr("does not begin with $MeshFormat"));
  EXPECT_THAT(complaint_about("solid cube\n"), HasSubstr("does not begin with $MeshFormat"));
  TwoCubes cubes;
  cubes.version = "4 0 8";
  EXPECT_THAT(complaint_about(cubes.text()), HasSubstr("Gmsh format 4 cannot be read"));
  cubes.version = "2.2 1 8";
  EXPECT_THAT(complaint_about(cubes.text()), HasSubstr("save as ASCII"));
}

TEST_F(GmshFile, WithoutPhysicalNamesIsRefusedWithTheKnownOnes) {
  TwoCubes cubes;
  cubes.names.clear();
  EXPECT_THAT(complaint_about(cubes.text()),
              AllOf(HasSubstr(file_.string()), HasSubstr("no physical volume has a name"),
                    HasSubstr("fin, silicone, wire"), HasSubstr("clamp, fin_surface")));
}

TEST_F(GmshFile, WithAnUnknownNameIsRefusedWithTheKnownOnes) {
  TwoCubes cubes;
  cubes.names = "3\n3 1 \"silicon\"\n3 2 \"wire\"\n2 1 \"clamp\"\n";
  EXPECT_THAT(complaint_about(cubes.text()),
              AllOf(HasSubstr("unknown physical volume 'silicon'"), HasSubstr("'silicone'"),
                    HasSubstr("fin, silicone, wire")));
  cubes.names = "3\n3 1 \"silicone\"\n3 2 \"wire\"\n2 1 \"bottom\"\n";
  EXPECT_THAT(complaint_about(cubes.text()),
              AllOf(HasSubstr("unknown physical surface 'bottom'"), HasSubstr("clamp")));
}

TEST_F(GmshFile, WithUnnamedCellsOrFacesIsRefusedWithTheLine) {
  TwoCubes cubes;
  cubes.elements[1] = "5 2 0 2 5 6 7 8 9 10 11 12";
  EXPECT_THAT(complaint_about(cubes.text()),
              AllOf(HasSubstr(".msh:30: "), HasSubstr("in no named physical volume")));
  cubes = TwoCubes();
  cubes.elements[2] = "3 2 17 1 1 2 3 4";
  EXPECT_THAT(complaint_about(cubes.text()),
              AllOf(HasSubstr(".msh:31: "), HasSubstr("in no named physical surface")));
}

TEST_F(GmshFile, WithASurfaceGroupBetweenBodiesIsRefusedWithItsName) {
  TwoCubes cubes;
  cubes.elements.push_back("3 2 3 3 5 6 7 8");
  EXPECT_THAT(complaint_about(cubes.text()),
              AllOf(HasSubstr(".msh:41: "), HasSubstr("'wire_surface' contains a face inside"),
                    HasSubstr("(5e-04, 5e-04, 0.001) m")));
}

TEST_F(GmshFile, WithAnUnmarkedOuterFaceIsRefusedWithItsPlace) {
  TwoCubes cubes;
  cubes.elements.pop_back();
  EXPECT_THAT(complaint_about(cubes.text()),
              AllOf(HasSubstr("1 outer faces are in no physical surface"),
                    HasSubstr("(5e-04, 5e-04, 0.002) m"), HasSubstr("Coherence")));
}

TEST_F(GmshFile, WithoutClampOrWithOneElsewhereIsRefused) {
  TwoCubes cubes;
  cubes.elements[2] = "3 2 2 1 1 2 3 4";
  EXPECT_THAT(complaint_about(cubes.text()),
              HasSubstr("no outer face is in a physical surface 'clamp'"));
  cubes.elements[2] = "3 2 1 1 1 2 3 4";
  cubes.lowest = -1.;
  EXPECT_THAT(complaint_about(cubes.text()), HasSubstr("'clamp' is not in the plane z = 0"));
}

TEST_F(GmshFile, OfBodiesThatShareNoFacesIsRefused) {
  // The same two cubes, the upper one on nodes of its own, as without Coherence.
  TwoCubes cubes;
  std::string text = cubes.text();
  text.replace(text.find("$Nodes\n12\n"), 10,
               "$Nodes\n16\n25 0 0 1e-3\n26 1e-3 0 1e-3\n27 1e-3 1e-3 1e-3\n28 0 1e-3 1e-3\n");
  text.replace(text.find("5 6 7 8 9 10 11 12"), 18, "25 26 27 28 9 10 11 12");
  for (const auto& [joined, apart] : {std::pair("3 3 5 6 10 9", "3 3 25 26 10 9"),
                                      {"3 3 6 7 11 10", "3 3 26 27 11 10"},
                                      {"3 3 7 8 12 11", "3 3 27 28 12 11"},
                                      {"3 3 8 5 9 12", "3 3 28 25 9 12"}})
    text.replace(text.find(joined), std::string(joined).size(), apart);
  text.replace(text.find("$Elements\n12\n"), 13,
               "$Elements\n14\n98 3 2 2 2 5 6 7 8\n99 3 2 3 3 25 26 27 28\n");
  EXPECT_THAT(complaint_about(text), HasSubstr("shares no faces with the rest of the sensor"));
}

TEST_F(GmshFile, InMillimetresIsRefused) {
  TwoCubes cubes;
  cubes.scale = 10.;
  EXPECT_THAT(complaint_about(cubes.text()), HasSubstr("coordinates must be in metres"));
}

TEST_F(GmshFile, WithOtherElementsThanFirstOrderHexahedraIsRefused) {
  TwoCubes cubes;
  cubes.elements[0] = "4 2 1 1 1 2 3 5";
  EXPECT_THAT(complaint_about(cubes.text()),
              AllOf(HasSubstr("element type 4"), HasSubstr("only first-order hexahedra")));
  cubes.elements[0] = "17 2 1 1 1 2 3 4 5 6 7 8 1 1 1 1 1 1 1 1 1 1 1 1";
  EXPECT_THAT(complaint_about(cubes.text()), HasSubstr("element type 17"));
  cubes = TwoCubes();
  cubes.elements.erase(cubes.elements.begin(), cubes.elements.begin() + 2);
  EXPECT_THAT(complaint_about(cubes.text()), HasSubstr("no hexahedra"));
}

TEST_F(GmshFile, WithRepeatedCellsFacesOrNodesIsRefused) {
  TwoCubes cubes;
  cubes.elements.push_back("5 2 2 1 2 3 4 1 6 7 8 5");
  EXPECT_THAT(complaint_about(cubes.text()), HasSubstr("this hexahedron is given twice"));
  cubes = TwoCubes();
  cubes.elements.push_back("3 2 3 3 4 3 2 1");
  EXPECT_THAT(complaint_about(cubes.text()), HasSubstr("this quadrangle is given twice"));
  cubes = TwoCubes();
  cubes.elements[0] = "5 2 1 1 1 2 3 4 5 6 7 7";
  EXPECT_THAT(complaint_about(cubes.text()), HasSubstr("uses a node twice"));
  cubes = TwoCubes();
  cubes.elements.push_back("5 2 1 1 5 6 7 8 1 2 3 9");
  EXPECT_THAT(complaint_about(cubes.text()), HasSubstr("more than two hexahedra share one face"));
  cubes = TwoCubes();
  cubes.elements.push_back("3 2 3 3 1 2 7 8");
  EXPECT_THAT(complaint_about(cubes.text()), HasSubstr("not a face of a hexahedron"));
  std::string text = TwoCubes().text();
  text.replace(text.find("\n2 0.001"), 2, "\n1");
  EXPECT_THAT(complaint_about(text), HasSubstr("node 1 is given twice"));
}

TEST_F(GmshFile, WithDamagedNumbersIsRefusedWithTheLine) {
  std::string text = TwoCubes().text();
  text.replace(text.find("2 0.001"), 7, "2 0,001");
  EXPECT_THAT(complaint_about(text),
              AllOf(HasSubstr(".msh:15: "), HasSubstr("expected a coordinate, found '0,001'")));
  text = TwoCubes().text();
  text.replace(text.find("2 0.001"), 7, "2 nan");
  EXPECT_THAT(complaint_about(text), HasSubstr("a coordinate is not finite"));
  text = TwoCubes().text();
  text.replace(text.find("10 11 12"), 8, "10 11 77");
  EXPECT_THAT(complaint_about(text), HasSubstr("refers to node 77, which is not given"));
  text = TwoCubes().text();
  text.replace(text.find("$Nodes\n12"), 9, "$Nodes\n-1");
  EXPECT_THAT(complaint_about(text), HasSubstr("expected the number of nodes, found '-1'"));
  text.replace(text.find("$Nodes\n-1"), 9, "$Nodes\n99999999");
  EXPECT_THAT(complaint_about(text), HasSubstr("99999999 nodes do not fit"));
  text = TwoCubes().text();
  text.replace(text.find("\"clamp\""), 7, "\"clamp");
  EXPECT_THAT(complaint_about(text), HasSubstr("lacks its closing quote"));
}

/// However a file is cut short, it is refused or, when only trailing text is lost, read whole.
TEST_F(GmshFile, CutShortAnywhereNeverGivesAnotherMesh) {
  for (const char* const name : {"two_bodies_22.msh", "two_bodies_41.msh"}) {
    const std::string text = text_of(data_file(name));
    read(text);
    const std::string whole = mesh_sha256(mesh_);
    for (std::size_t size = 0; size < text.size(); size += 23) {
      const std::string complaint = complaint_about(text.substr(0, size));
      if (complaint == "no complaint") {
        EXPECT_EQ(mesh_sha256(mesh_), whole) << name << " cut at " << size;
      }
    }
  }
}

TEST_F(GmshFile, WithAVolumeInTwoGroupsIsRefused) {
  std::string text = text_of(data_file("two_bodies_41.msh"));
  const std::size_t volume = text.find("0.003 1 1 6");
  ASSERT_NE(volume, std::string::npos);
  text.replace(volume, 11, "0.003 2 1 2 6");
  EXPECT_THAT(complaint_about(text), HasSubstr("an entity is in 2 physical groups"));
}

}  // namespace
}  // namespace vibrissa::meshes
