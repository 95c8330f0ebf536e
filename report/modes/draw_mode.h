#pragma once

#include <filesystem>

#include "report/figures/mode_picture.h"

class vtkRenderWindow;

namespace vibrissa::report {

/// Draws the deformed mesh, coloured, with its outline at rest, a colour bar and the scale of the
/// deformation to a PNG file. The vtu is looked for in the run folder. Needs a display, else VTK
/// aborts the program: see draw_pictures(). Throws UserError like read_deformed_mesh(), and for a
/// file that cannot be written. Proven by tests/report/drawing/draw_test.cc.
void draw_mode(const ModePicture& picture, const std::filesystem::path& run_folder,
               const std::filesystem::path& png);

/// Drawing in the window aborts the program when no display can be opened.
void prepare_offscreen(vtkRenderWindow& window, int width, int height);

}  // namespace vibrissa::report
