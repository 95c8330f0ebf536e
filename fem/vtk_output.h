#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "fem/sensor.h"

namespace vibrissa::fem {

/// Writes one .vtu of quadratic cells: displacement [m] at the nodes; region, von Mises stress and
/// pressure [Pa] per cell (means over the cell; pressure from the projected volume change, positive
/// in compression). time_s is written as the file's TimeValue.
void write_vtu(const std::filesystem::path& file, const Sensor& sensor, const Vector& displacement,
               double time_s);

/// A .pvd that lists .vtu files beside it with their times.
void write_pvd(const std::filesystem::path& file, std::span<const double> times_s,
               std::span<const std::string> vtu_names);

/// One mode as an animation: n_frames .vtu over one period and mode_K.pvd, scaled so that the
/// largest displacement is a tenth of the sensor's height. number counts from 1. Returns the .pvd.
std::filesystem::path write_mode_animation(const std::filesystem::path& folder,
                                           const Sensor& sensor, std::size_t number,
                                           unsigned int n_frames = 12);

}  // namespace vibrissa::fem
