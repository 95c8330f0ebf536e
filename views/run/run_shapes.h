#pragma once

#include <filesystem>
#include <vector>

#include "fem/sensor/sensor.h"
#include "report/figures/mode_picture.h"

namespace vibrissa::views {

/// Writes VTK files of the first six modes and of the sensor under 1 g of base acceleration with
/// its stresses, and returns the pictures to show, the loaded sensor last. folder is named vtk.
/// Collective. Proven by tests/apps/commands_test.cc.
std::vector<report::ModePicture> write_shapes(const std::filesystem::path& folder,
                                              const fem::Sensor& sensor);

}  // namespace vibrissa::views
