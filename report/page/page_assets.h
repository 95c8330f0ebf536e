#pragma once

#include <string_view>

namespace vibrissa::report {

/// Files of report/page and of the JavaScript libraries, as they were at the time of the build
/// (made by cmake/VibrissaEmbed.cmake), so that the program needs none of them when it runs.
std::string_view page_template();
std::string_view page_style();
std::string_view page_script();
std::string_view page_scene_script();
std::string_view page_licences();
std::string_view dygraphs_style();
std::string_view dygraphs_script();
std::string_view three_script();
std::string_view orbit_controls_script();

}  // namespace vibrissa::report
