#include "report/modes/deformed_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkMassProperties.h>
#include <vtkTriangleFilter.h>

#include <cmath>

#include "signals/base/error.h"
#include "tests/report/meshes.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::report {
namespace {

using signals::UserError;
using signals::test::content_of;
using signals::test::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double width = 0.01, height = 0.1;

testing::Point bending(const testing::Point& x) {
  return {1e-5 * x[2] * x[2] / (height * height), 0., 0.};
}

class DeformedMeshFile : public ::testing::Test {
 protected:
  DeformedMeshFile() : grid_(testing::column_mesh(5, width, height, bending)) {
    picture_.displacement = "displacement_m";
  }
  DeformedMesh read() {
    testing::write_grid(file_, *grid_);
    return read_deformed_mesh(file_, picture_);
  }
  void add(vtkDataSetAttributes& data, const char* name, const int n, const double value) const {
    vtkNew<vtkDoubleArray> array;
    array->SetName(name);
    for (int i = 0; i < n; ++i) array->InsertNextValue(value * (i + 1));
    data.AddArray(array);
  }
  auto refusal(const std::string& text) {
    return ThrowsMessage<UserError>(AllOf(HasSubstr("mesh.vtu"), HasSubstr(text)));
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "mesh.vtu";
  vtkSmartPointer<vtkUnstructuredGrid> grid_;
  ModePicture picture_;
};

double area(vtkPolyData& surface) {
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputData(&surface);
  vtkNew<vtkMassProperties> properties;
  properties->SetInputConnection(triangles->GetOutputPort());
  return properties->GetSurfaceArea();
}

TEST_F(DeformedMeshFile, HasTheOuterSurfaceAloneThoughCellsRepeatTheirPoints) {
  EXPECT_NEAR(area(*read().rest), 2. * width * width + 4. * width * height, 1e-8);
}

TEST_F(DeformedMeshFile, SharesPointsThatDifferByRoundingAlone) {
  for (vtkIdType i = 0; i < grid_->GetNumberOfPoints(); ++i) {
    double x[3];
    grid_->GetPoint(i, x);
    grid_->GetPoints()->SetPoint(i, x[0], x[1], x[2] + (i % 3) * 3e-9);
  }
  EXPECT_NEAR(area(*read().rest), 2. * width * width + 4. * width * height, 1e-8);
}

TEST_F(DeformedMeshFile, HasThePointsInTheMiddleOfQuadraticCells) {
  const DeformedMesh mesh = read();
  int n_in_the_middle = 0;
  for (vtkIdType i = 0; i < mesh.rest->GetNumberOfPoints(); ++i)
    n_in_the_middle += std::abs(mesh.rest->GetPoint(i)[2] - height / 10.) < 1e-6;
  EXPECT_EQ(n_in_the_middle, 8) << "corners and middles of the four sides";
}

TEST_F(DeformedMeshFile, MovesByTheScaledDisplacement) {
  picture_.scale = 200.;
  const DeformedMesh mesh = read();
  ASSERT_EQ(mesh.rest->GetNumberOfPoints(), mesh.deformed->GetNumberOfPoints());
  for (vtkIdType i = 0; i < mesh.rest->GetNumberOfPoints(); ++i) {
    double before[3], after[3];
    mesh.rest->GetPoint(i, before);
    mesh.deformed->GetPoint(i, after);
    const auto move = bending({before[0], before[1], before[2]});
    EXPECT_NEAR(after[0], before[0] + 200. * move[0], 1e-7);
    EXPECT_NEAR(after[1], before[1], 1e-7);
    EXPECT_NEAR(after[2], before[2], 1e-7);
  }
}

TEST_F(DeformedMeshFile, ChoosesAScaleThatShows) {
  const DeformedMesh mesh = read();
  // 15 % of the diagonal, 0.1010 m, over 1e-5 m is 1515; the next lower round number is 1000.
  EXPECT_NEAR(mesh.scale, 1000., 1e-9);
}

TEST_F(DeformedMeshFile, IsShownToScaleWhereNothingMoves) {
  grid_ = testing::column_mesh(1, width, height, [](auto) { return testing::Point{}; });
  EXPECT_EQ(read().scale, 1.);
}

TEST_F(DeformedMeshFile, IsColouredByTheSizeOfTheDisplacement) {
  picture_.colour_factor = 1e3;
  const DeformedMesh mesh = read();
  EXPECT_NEAR(mesh.colours.low, 0., 1e-12);
  EXPECT_NEAR(mesh.colours.high, 1e-2, 1e-9);
}

TEST_F(DeformedMeshFile, IsColouredByAFieldAtPointsOrCells) {
  add(*grid_->GetPointData(), "temperature_K", 5 * 27, 1.);
  add(*grid_->GetCellData(), "pressure_Pa", 5, -2.);
  picture_.colour_field = "temperature_K";
  EXPECT_TRUE(read().deformed->GetPointData()->HasArray(colour_array));
  picture_.colour_field = "pressure_Pa";
  const DeformedMesh mesh = read();
  EXPECT_TRUE(mesh.deformed->GetCellData()->HasArray(colour_array));
  EXPECT_EQ(mesh.colours, (Range{-10., -2.}));
}

TEST_F(DeformedMeshFile, RefusesFieldsThatAreNotThereListingThoseThatAre) {
  add(*grid_->GetCellData(), "pressure_Pa", 5, 1.);
  picture_.displacement = "displacment_m";
  EXPECT_THAT([&] { read(); }, refusal("did you mean 'displacement_m'"));
  picture_.displacement = "displacement_m";
  picture_.colour_field = "stress";
  EXPECT_THAT([&] { read(); }, refusal("pressure_Pa"));
  picture_.colour_field = "displacement_m";
  EXPECT_THAT([&] { read(); }, refusal("unknown scalar field"));
}

TEST_F(DeformedMeshFile, RefusesValuesThatAreNotFinite) {
  grid_->GetPointData()->GetArray("displacement_m")->SetComponent(3, 1, std::nan(""));
  EXPECT_THAT([&] { read(); }, refusal("not finite"));
}

TEST_F(DeformedMeshFile, RefusesFilesThatAreNoMesh) {
  EXPECT_THAT([&] { read_deformed_mesh(file_, picture_); }, refusal("does not exist"));
  folder_.file("mesh.vtu", "some text");
  EXPECT_THAT([&] { read_deformed_mesh(file_, picture_); }, refusal("not a VTK file"));
  grid_ = testing::column_mesh(0, width, height, bending);
  EXPECT_THAT([&] { read(); }, refusal("no cells"));
}

TEST_F(DeformedMeshFile, RefusesADamagedFile) {
  read();
  const std::string whole = content_of(file_);
  for (const double part : {0.3, 0.6, 0.9}) {
    const auto size = static_cast<std::size_t>(part * static_cast<double>(whole.size()));
    folder_.file("mesh.vtu", whole.substr(0, size));
    EXPECT_THAT([&] { read_deformed_mesh(file_, picture_); }, refusal("damaged")) << part;
  }
  std::string changed = whole;
  changed.replace(changed.find("<AppendedData") + 100, 20, 20, 'A');
  folder_.file("mesh.vtu", changed);
  EXPECT_THAT([&] { read_deformed_mesh(file_, picture_); }, refusal("damaged"));
}

}  // namespace
}  // namespace vibrissa::report
