#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "fem/sensor/sensor.h"

namespace vibrissa::fem {

/// Writes one .vtu of quadratic cells: displacement [m] at the nodes; region, von Mises stress and
/// pressure [Pa] per cell (means over the cell; pressure from the projected volume change, positive
/// in compression). time_s is written as the file's TimeValue. Several processes write a part each,
/// NAME.K.vtu, and the first NAME.pvtu, which lists them, once they are there. Collective; returns
/// the file to open. Proven by tests/fem/sensor/vtk_output_test.cc and processes_test.cc.
std::filesystem::path write_vtu(const std::filesystem::path& file, const Sensor& sensor,
                                const Vector& displacement, double time_s);

/// A .pvd that lists .vtu or .pvtu files beside it with their times; written by the first process.
void write_pvd(const std::filesystem::path& file, std::span<const double> times_s,
               std::span<const std::string> vtu_names);

/// One mode as an animation: n_frames .vtu over one period and mode_K.pvd, scaled so that the
/// largest displacement is a tenth of the sensor's height. number counts from 1. Returns the .pvd.
std::filesystem::path write_mode_animation(const std::filesystem::path& folder,
                                           const Sensor& sensor, std::size_t number,
                                           unsigned int n_frames = 12);

}  // namespace vibrissa::fem
