#pragma once

#include <filesystem>

namespace vibrissa::report {

/// Draws FOLDER/figures/NAME.scene.json (mode_picture.h) to NAME.png beside them on the current
/// display, without which VTK aborts the program, and prints a line for each picture and each
/// problem (picture_lines.h). Returns whether all were drawn. Proven by
/// tests/report/files/pictures_test.cc.
bool draw_scenes(const std::filesystem::path& folder);

}  // namespace vibrissa::report
