#pragma once

#include <string>

class vtkTextProperty;

namespace vibrissa::report {

/// Dark text of a size in pixels in DejaVu Sans where it is installed (it has all the signs that
/// labels use), else in VTK's own font.
void set_lettering(vtkTextProperty& property, int size, bool bold = false);

/// What can be printed with the font in use: without DejaVu Sans superscripts become "^-3", as a
/// sign that VTK's font lacks would vanish and turn 10⁻³ into 10³.
std::string printable(const std::string& text);

/// In pixels, as set_lettering() and printable() would draw it. Needs no display.
double text_width(const std::string& text, int size, bool bold);

/// The rule behind printable(), independent of the fonts that are installed.
std::string without_superscripts(const std::string& text);

}  // namespace vibrissa::report
