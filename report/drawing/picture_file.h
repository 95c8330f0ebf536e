#pragma once

#include <vtkSmartPointer.h>

#include <filesystem>
#include <string>

class vtkRenderWindow;

namespace vibrissa::report {

/// Keeps the display open from one picture to the next: a virtual one starts anew whenever its last
/// window closes, and may then miss the next.
class OpenDisplay {
 public:
  OpenDisplay();
  ~OpenDisplay();
  OpenDisplay(const OpenDisplay&) = delete;
  OpenDisplay& operator=(const OpenDisplay&) = delete;

 private:
  vtkSmartPointer<vtkRenderWindow> window_;
};

/// A window that never appears on the screen. Making pictures in it
/// aborts the program when no display can be opened: see draw_pictures().
void prepare_offscreen(vtkRenderWindow& window, int width, int height);

/// Pixels of a window are this much finer than those of its PNG file, for smooth edges.
inline constexpr int oversampling = 2;

/// Renders the window and writes it, smaller by oversampling, to a PNG file, which is whole or not
/// there at all. Throws UserError with the
/// path when it cannot be written.
void write_png(vtkRenderWindow& window, const std::filesystem::path& file);

/// The same to SVG: lines stay lines, and letters become outlines that look alike in every viewer.
/// Title and caption go into the file as text.
void write_svg(vtkRenderWindow& window, const std::filesystem::path& file, const std::string& title,
               const std::string& caption);

}  // namespace vibrissa::report
