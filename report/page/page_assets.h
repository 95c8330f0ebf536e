#pragma once

#include <string_view>

namespace vibrissa::report {

/// Files of report/page and of the JavaScript libraries, embedded at build time by
/// cmake/VibrissaEmbed.cmake, so that the program does not need them when it runs.
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
