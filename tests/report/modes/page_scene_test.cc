#include "report/modes/page_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "signals/base/error.h"
#include "tests/report/meshes.h"
#include "tests/report/unpacked.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::report {
namespace {

using signals::UserError;
using signals::test::TemporaryFolder;
using ::testing::HasSubstr;

constexpr double width = 0.01, height = 0.1;

class PageScene : public ::testing::Test {
 protected:
  PageScene() {
    testing::write_grid(folder_.path() / "m.vtu",
                        *testing::column_mesh(5, width, height, [](const testing::Point& x) {
                          return testing::Point{2. * x[2], 0., 0.};
                        }));
    picture_ = {.name = "m",
                .title = "Mode",
                .vtu = "m.vtu",
                .displacement = "displacement_m",
                .colour_label = "Size, [m]",
                .scale = 3.};
  }
  std::vector<double> list(const char* name) const {
    return testing::unpacked(numbers_.json()[scene_[name].get<std::size_t>()]);
  }

  TemporaryFolder folder_;
  ModePicture picture_;
  PackedNumbers numbers_;
  nlohmann::json scene_;
};

TEST_F(PageScene, HoldsTheSurfaceItsMotionAndItsColours) {
  scene_ = page_scene(folder_.path(), picture_, numbers_);
  const auto points = list("points"), moves = list("moves"), values = list("values");
  ASSERT_EQ(moves.size(), points.size());
  ASSERT_EQ(3 * values.size(), points.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(moves[3 * i], 3. * 2. * points[3 * i + 2], 1e-6);
    EXPECT_NEAR(values[i], 2. * points[3 * i + 2], 1e-6);
  }
  double area = 0.;
  const auto triangles = list("triangles");
  const auto corner = [&](std::size_t t) {
    const auto p = 3 * static_cast<std::size_t>(triangles[t]);
    return testing::Point{points[p], points[p + 1], points[p + 2]};
  };
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const auto a = corner(t), b = corner(t + 1), c = corner(t + 2);
    const double u[] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const double v[] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    area += 0.5 * std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                             u[0] * v[1] - u[1] * v[0]);
  }
  EXPECT_NEAR(area, 4. * width * height + 2. * width * width, 1e-7);
  EXPECT_NEAR(scene_["range"][1].get<double>(), 2. * height, 1e-7);
  EXPECT_EQ(scene_["colours"].size(), 256u);
  EXPECT_EQ(scene_["colours"][0], "#440154");  // of viridis
  EXPECT_EQ(scene_["csv"], "\"Size, [m]\"");
}

TEST_F(PageScene, TellsValuesOfCellsFromValuesOfPoints) {
  scene_ = page_scene(folder_.path(), picture_, numbers_);
  EXPECT_FALSE(scene_["of_cells"]);
  auto grid = testing::column_mesh(5, width, height, [](const testing::Point&) {
    return testing::Point{1., 0., 0.};
  });
  vtkNew<vtkDoubleArray> stress;
  stress->SetName("stress_Pa");
  for (int c = 0; c < 5; ++c) stress->InsertNextValue(c);
  grid->GetCellData()->AddArray(stress);
  testing::write_grid(folder_.path() / "m.vtu", *grid);
  picture_.colour_field = "stress_Pa";
  scene_ = page_scene(folder_.path(), picture_, numbers_);
  EXPECT_TRUE(scene_["of_cells"]);
  EXPECT_EQ(3 * list("values").size(), list("triangles").size());
}

TEST_F(PageScene, NamesTheMeshThatIsMissing) {
  picture_.vtu = "nowhere.vtu";
  EXPECT_THAT([&] { page_scene(folder_.path(), picture_, numbers_); },
              ::testing::ThrowsMessage<UserError>(HasSubstr("nowhere.vtu")));
}

}  // namespace
}  // namespace vibrissa::report
