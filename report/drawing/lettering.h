#pragma once

#include <string>

class vtkTextProperty;

namespace vibrissa::report {

/// Dark text of a size in pixels in DejaVu Sans when it is installed (it has all characters that
/// labels use), otherwise in VTK's own font.
void set_lettering(vtkTextProperty& property, int size, bool bold = false);

/// The text as the current font can print it. Without DejaVu Sans superscripts become "^-3",
/// because a character missing in VTK's font would vanish and turn 10⁻³ into 10³.
std::string printable(const std::string& text);

/// Size in pixels as drawn with set_lettering() and printable(). Needs no display.
double text_width(const std::string& text, int size, bool bold);

/// The replacement rule of printable(), independent of the installed fonts.
std::string without_superscripts(const std::string& text);

}  // namespace vibrissa::report
