#pragma once

#include "report/drawing/placed_text.h"
#include "report/figures/palette.h"

class vtkContext2D;

namespace vibrissa::report {

/// Basic paint operations on a page, in pixels.
void set_pen(vtkContext2D& painter, const Colour& colour, double width);
void set_fill(vtkContext2D& painter, const Colour& colour);
void draw_line(vtkContext2D& painter, double x0, double y0, double x1, double y1);
void paint_text(vtkContext2D& painter, const PlacedText& placed);

}  // namespace vibrissa::report
