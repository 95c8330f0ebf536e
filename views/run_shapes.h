#pragma once

#include <filesystem>
#include <vector>

#include "fem/sensor/sensor.h"
#include "report/modes/mode_picture.h"

namespace vibrissa::views {

/// The sensor in its first six modes, each as an animation, and bent by 1 g of base acceleration,
/// with the stresses of that: VTK files of a folder named vtk, and what to show of them, the bent
/// sensor last. Collective. Proven by tests/apps/commands_test.cc.
std::vector<report::ModePicture> write_shapes(const std::filesystem::path& folder,
                                              const fem::Sensor& sensor);

}  // namespace vibrissa::views
