#include "report/page_painter.h"

#include <vtkBrush.h>
#include <vtkContext2D.h>
#include <vtkObjectFactory.h>
#include <vtkPen.h>
#include <vtkTextProperty.h>

#include <cassert>

#include "report/curve_look.h"
#include "report/lettering.h"

namespace vibrissa::report {
namespace {

constexpr double title_row = 32., row = 26., tick_gap = 12.;
constexpr Colour grid_colour = {221, 221, 221}, fine_grid_colour = {240, 240, 240},
                 frame_colour = {110, 110, 110};

enum class At { left, centre, right };

void write(vtkContext2D& painter, const std::string& text, const double x, const double y,
           const int size, const At at, const bool bold = false, const bool upward = false) {
  vtkNew<vtkTextProperty> property;
  set_lettering(*property, size, bold);
  property->SetJustification(at == At::left     ? VTK_TEXT_LEFT
                             : at == At::centre ? VTK_TEXT_CENTERED
                                                : VTK_TEXT_RIGHT);
  property->SetVerticalJustificationToCentered();
  property->SetOrientation(upward ? 90. : 0.);
  painter.ApplyTextProp(property);
  painter.DrawString(static_cast<float>(x), static_cast<float>(y), printable(text).c_str());
}

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

double pixel(const Axis& axis, const double at, const double start, const double length) {
  return start + length * (at - axis.range.low) / axis.range.length();
}

void paint_grid(vtkContext2D& painter, const PanelLayout& placed, const bool fine) {
  set_pen(painter, fine ? fine_grid_colour : grid_colour, 1.);
  const Box& plot = placed.plot;
  for (const Tick& mark : placed.x.ticks.marks) {
    const double x = pixel(placed.x, mark.at, plot.left, plot.width);
    if (mark.label.empty() == fine) draw_line(painter, x, plot.bottom, x, plot.top());
  }
  for (const Tick& mark : placed.y.ticks.marks) {
    const double y = pixel(placed.y, mark.at, plot.bottom, plot.height);
    if (mark.label.empty() == fine) draw_line(painter, plot.left, y, plot.right(), y);
  }
}

void paint_frame(vtkContext2D& painter, const Box& plot) {
  set_pen(painter, frame_colour, 1.);
  draw_line(painter, plot.left, plot.bottom, plot.right(), plot.bottom);
  draw_line(painter, plot.left, plot.top(), plot.right(), plot.top());
  draw_line(painter, plot.left, plot.bottom, plot.left, plot.top());
  draw_line(painter, plot.right(), plot.bottom, plot.right(), plot.top());
}

void paint_ticks(vtkContext2D& painter, const PanelLayout& placed) {
  constexpr double long_tick = 6., short_tick = 3.;
  set_pen(painter, frame_colour, 1.);
  const Box& plot = placed.plot;
  for (const Tick& mark : placed.x.ticks.marks) {
    const double x = pixel(placed.x, mark.at, plot.left, plot.width);
    draw_line(painter, x, plot.bottom, x,
              plot.bottom - (mark.label.empty() ? short_tick : long_tick));
  }
  for (const Tick& mark : placed.y.ticks.marks) {
    const double y = pixel(placed.y, mark.at, plot.bottom, plot.height);
    draw_line(painter, plot.left - (mark.label.empty() ? short_tick : long_tick), y, plot.left, y);
  }
}

void paint_labels(vtkContext2D& painter, const PanelLayout& placed) {
  const Box& plot = placed.plot;
  double y = plot.bottom - tick_gap - 1.5 * row;
  if (placed.x.labelled)
    for (const auto& line : placed.x.label_lines) {
      write(painter, line, plot.left + plot.width / 2., y, letter::label, At::centre);
      y -= row;
    }
  double x = row;
  for (const auto& line : placed.y.label_lines) {
    write(painter, line, x, plot.bottom + plot.height / 2., letter::label, At::centre, false, true);
    x += row;
  }
}

}  // namespace

vtkStandardNewMacro(PagePainter);

}  // namespace vibrissa::report
