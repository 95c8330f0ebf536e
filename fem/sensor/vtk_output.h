#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "fem/sensor/sensor.h"

namespace vibrissa::fem {

/// Writes one .vtu of quadratic cells: displacement [m] at the nodes; region, von Mises stress and
/// pressure [Pa] in each cell (means over the cell; pressure from the projected volume change,
/// positive in compression). time_s is written as TimeValue of the file. With several processes
/// each writes its part, NAME.K.vtu; afterwards the first process writes NAME.pvtu, which lists
/// them. Collective; returns the file to open. Proven by tests/fem/sensor/vtk_output_test.cc and
/// processes_test.cc.
std::filesystem::path write_vtu(const std::filesystem::path& file, const Sensor& sensor,
                                const Vector& displacement, double time_s);

/// Writes a .pvd that lists .vtu or .pvtu files of the same folder with their times; the first
/// process writes it.
void write_pvd(const std::filesystem::path& file, std::span<const double> times_s,
               std::span<const std::string> vtu_names);

/// Writes one mode as an animation: n_frames .vtu files over one period and mode_K.pvd, scaled so
/// that the largest displacement is a tenth of the height of the sensor. number starts at 1.
/// Returns the .pvd file.
std::filesystem::path write_mode_animation(const std::filesystem::path& folder,
                                           const Sensor& sensor, std::size_t number,
                                           unsigned int n_frames = 12);

}  // namespace vibrissa::fem
