#pragma once

#include <vtkSmartPointer.h>

#include <filesystem>
#include <string>

class vtkRenderWindow;

namespace vibrissa::report {

/// Keeps the display open between pictures: a virtual display restarts when its last window closes,
/// and may then miss the next window.
class OpenDisplay {
 public:
  OpenDisplay();
  ~OpenDisplay();
  OpenDisplay(const OpenDisplay&) = delete;
  OpenDisplay& operator=(const OpenDisplay&) = delete;

 private:
  vtkSmartPointer<vtkRenderWindow> window_;
};

/// An off-screen window. Drawing in it aborts the program when no display can be opened: see
/// draw_pictures().
void prepare_offscreen(vtkRenderWindow& window, int width, int height);

/// Oversampling of a window relative to its PNG file, for smooth edges.
inline constexpr int oversampling = 2;

/// Renders the window and writes it, reduced by the oversampling, to a PNG file. The file is
/// complete or does not exist. Throws UserError with the path when it cannot be written.
void write_png(vtkRenderWindow& window, const std::filesystem::path& file);

/// The same as SVG: lines stay lines, and letters become outlines, which look the same in every
/// viewer. Title and caption are stored in the file as text.
void write_svg(vtkRenderWindow& window, const std::filesystem::path& file, const std::string& title,
               const std::string& caption);

}  // namespace vibrissa::report
