#include "report/modes/mesh_view.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/report/meshes.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::report {
namespace {

constexpr double degree = 3.14159265358979323846 / 180.;

MeshView view_for(const testing::Field& field) {
  const signals::test::TemporaryFolder folder;
  testing::write_grid(folder.path() / "a.vtu", *testing::column_mesh(4, 0.01, 0.1, field));
  ModePicture picture;
  picture.displacement = "displacement_m";
  return view_of(read_deformed_mesh(folder.path() / "a.vtu", picture));
}

TEST(MeshView, LooksFromTheSideOfTheMotionALittleTurned) {
  for (const double angle : {0., 30., 80., -50.}) {
    const Eigen::Vector3d motion(std::cos(angle * degree), std::sin(angle * degree), 0.);
    const MeshView view = view_for([&](const testing::Point& x) {
      return testing::Point{x[2] * motion.x(), x[2] * motion.y(), 0.};
    });
    EXPECT_NEAR(std::abs(view.right.dot(motion)), std::cos(20. * degree), 1e-6) << angle;
  }
}

TEST(MeshView, IsARightHandedFrameWithZUpright) {
  const MeshView view = view_for([](const testing::Point& x) {
    return testing::Point{x[2], 0., 0.};
  });
  EXPECT_NEAR((view.right.cross(view.up) - view.toward).norm(), 0., 1e-12);
  EXPECT_NEAR(view.right.norm(), 1., 1e-12);
  EXPECT_NEAR(view.up.norm(), 1., 1e-12);
  EXPECT_EQ(view.right.z(), 0.);
  EXPECT_GT(view.up.z(), 0.9);
  EXPECT_GT(view.toward.z(), 0.) << "from above";
}

TEST(MeshView, HoldsTheMeshBeforeAndAfter) {
  const MeshView view = view_for([](const testing::Point& x) {
    return testing::Point{x[2], 0., 0.};
  });
  // Rest: 0.1 high. Deformed by up to 0.01 = 15 % of 0.101, rounded down, of the length.
  EXPECT_GT(view.height, 0.1 * std::cos(18. * degree));
  EXPECT_LT(view.height, 0.13);
  EXPECT_GT(view.width, 0.01 * std::cos(20. * degree) + 0.01);
  EXPECT_LT(view.width, 0.03);
}

TEST(MeshView, HasADirectionForTorsionAndForNoMotion) {
  for (const double size : {0., 1.}) {
    const MeshView view = view_for([&](const testing::Point& x) {
      return testing::Point{-size * x[1] * x[2], size * x[0] * x[2], 0.};
    });
    EXPECT_NEAR(view.right.x(), std::cos(20. * degree), 1e-6);
  }
}

}  // namespace
}  // namespace vibrissa::report
