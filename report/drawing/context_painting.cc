#include "report/drawing/context_painting.h"

#include <vtkBrush.h>
#include <vtkContext2D.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkTextProperty.h>

#include "report/drawing/lettering.h"

namespace vibrissa::report {

void set_pen(vtkContext2D& painter, const Colour& colour, const double width) {
  painter.GetPen()->SetLineType(vtkPen::SOLID_LINE);
  painter.GetPen()->SetColor(colour[0], colour[1], colour[2], 255);
  painter.GetPen()->SetWidth(static_cast<float>(width));
}

void draw_line(vtkContext2D& painter, const double x0, const double y0, const double x1,
               const double y1) {
  painter.DrawLine(static_cast<float>(x0), static_cast<float>(y0), static_cast<float>(x1),
                   static_cast<float>(y1));
}

void set_fill(vtkContext2D& painter, const Colour& colour) {
  painter.GetPen()->SetLineType(vtkPen::NO_PEN);
  painter.GetBrush()->SetColor(colour[0], colour[1], colour[2], 255);
}

void paint_text(vtkContext2D& painter, const PlacedText& placed) {
  vtkNew<vtkTextProperty> property;
  set_lettering(*property, placed.size, placed.bold);
  property->SetJustification(placed.anchor == Anchor::left     ? VTK_TEXT_LEFT
                             : placed.anchor == Anchor::centre ? VTK_TEXT_CENTERED
                                                               : VTK_TEXT_RIGHT);
  property->SetVerticalJustificationToCentered();
  property->SetOrientation(placed.upward ? 90. : 0.);
  painter.ApplyTextProp(property);
  painter.DrawString(static_cast<float>(placed.x), static_cast<float>(placed.y),
                     printable(placed.text).c_str());
}

}  // namespace vibrissa::report
