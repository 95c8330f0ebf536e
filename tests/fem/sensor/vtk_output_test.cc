#include <gmock/gmock.h>  // before deal.II, whose Assert is a macro

#include "fem/sensor/vtk_output.h"

#include <fstream>
#include <sstream>

#include "tests/fem/file_content.h"
#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

TEST(VtkOutput, ModeAnimationListsItsFramesWithTimesAndNamedFields) {
  const auto folder = std::filesystem::temp_directory_path() / "vibrissa_vtk_output_test";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directory(folder);
  const Sensor sensor(whisker_sensor(1));
  const auto pvd = write_mode_animation(folder, sensor, 1, 3);
  const std::string list = content(pvd);
  for (const std::string frame : {"mode_1_0.vtu", "mode_1_1.vtu", "mode_1_2.vtu"}) {
    EXPECT_THAT(list, testing::HasSubstr(frame));
    const std::string vtu = content(folder / frame);
    for (const std::string field :
         {"displacement_m", "von_mises_stress_Pa", "pressure_Pa", "region", "TIME"}) {
      EXPECT_THAT(vtu, testing::HasSubstr(field));
    }
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace vibrissa::fem
