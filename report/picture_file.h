#pragma once

#include <filesystem>
#include <string>

class vtkRenderWindow;

namespace vibrissa::report {

/// A window that never appears on the screen, white, with smooth edges. Making pictures in it
/// aborts the program when no display can be opened: see draw_pictures().
void prepare_offscreen(vtkRenderWindow& window, int width, int height);

/// Renders the window to a PNG file, which is whole or not there at all. Throws UserError with the
/// path when it cannot be written.
void write_png(vtkRenderWindow& window, const std::filesystem::path& file);

/// The same to SVG: lines stay lines, and letters become outlines that look alike in every viewer.
/// Title and caption go into the file as text.
void write_svg(vtkRenderWindow& window, const std::filesystem::path& file, const std::string& title,
               const std::string& caption);

}  // namespace vibrissa::report
