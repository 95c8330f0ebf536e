#pragma once

#include <string_view>

namespace vibrissa::sensor_case {

/// The case files of cases/ as they were at the time of the build (made by
/// cmake/VibrissaEmbed.cmake), for people who have the program alone.
std::string_view flow_sensor_case();
std::string_view whisker_sensor_case();

}  // namespace vibrissa::sensor_case
