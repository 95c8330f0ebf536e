#pragma once

#include <string_view>

namespace vibrissa::sensor_case {

/// The case files of cases/ at the time of the build (embedded by cmake/VibrissaEmbed.cmake), for
/// users who have only the program.
std::string_view flow_sensor_case();
std::string_view whisker_sensor_case();

}  // namespace vibrissa::sensor_case
