#include "report/drawing/page_painter.h"

#include <vtkContext2D.h>
#include <vtkObjectFactory.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "report/drawing/context_painting.h"

namespace vibrissa::report {
namespace {

constexpr Colour grid_colour = {221, 221, 221}, fine_grid_colour = {240, 240, 240};
constexpr Colour frame_colour = {110, 110, 110};

/// The middle of a pixel, because a thin line between two pixels would be wide and pale.
double middle(const double pixel, const double width) {
  return (std::floor(pixel / width) + 0.5) * width;
}

/// Draws one panel without its texts and curves.
class PanelPainter {
 public:
  PanelPainter(vtkContext2D& painter, const Strokes& strokes, const PanelLayout& placed)
      : painter_(painter),
        strokes_(strokes),
        placed_(placed),
        left_(middle(placed.plot.left, strokes.thin)),
        right_(middle(placed.plot.right(), strokes.thin)),
        bottom_(middle(placed.plot.bottom, strokes.thin)),
        top_(middle(placed.plot.top(), strokes.thin)) {}

  void paint_grid(const bool fine) const {
    set_pen(painter_, fine ? fine_grid_colour : grid_colour, strokes_.thin);
    for (const Tick& mark : placed_.x.ticks.marks)
      if (mark.label.empty() == fine) draw_line(painter_, x(mark), bottom_, x(mark), top_);
    for (const Tick& mark : placed_.y.ticks.marks)
      if (mark.label.empty() == fine) draw_line(painter_, left_, y(mark), right_, y(mark));
  }

  void paint_frame() const {
    set_pen(painter_, frame_colour, strokes_.thin);
    draw_line(painter_, left_, bottom_, right_, bottom_);
    draw_line(painter_, left_, top_, right_, top_);
    draw_line(painter_, left_, bottom_, left_, top_);
    draw_line(painter_, right_, bottom_, right_, top_);
    for (const Tick& mark : placed_.x.ticks.marks)
      draw_line(painter_, x(mark), bottom_ - length(mark), x(mark), bottom_);
    for (const Tick& mark : placed_.y.ticks.marks)
      draw_line(painter_, left_ - length(mark), y(mark), left_, y(mark));
  }

 private:
  double x(const Tick& mark) const {
    return middle(placed_.plot.left + placed_.plot.width * placed_.x.part(mark.at), strokes_.thin);
  }
  double y(const Tick& mark) const {
    return middle(placed_.plot.bottom + placed_.plot.height * placed_.y.part(mark.at),
                  strokes_.thin);
  }
  double length(const Tick& mark) const {
    return mark.label.empty() ? strokes_.short_tick : strokes_.long_tick;
  }

  vtkContext2D& painter_;
  const Strokes& strokes_;
  const PanelLayout& placed_;
  double left_, right_, bottom_, top_;
};

void paint_sample(vtkContext2D& painter, const Strokes& strokes, const Panel& panel,
                  const LegendSample& sample) {
  const double right = sample.left + strokes.sample_width;
  const CurveStyle style = panel.curves[sample.curve].style;
  Colour colour = palette_colour(colour_number(panel, sample.curve));
  if (style == CurveStyle::line || style == CurveStyle::dashed) {
    set_pen(painter, colour, strokes.line);
    const double step = style == CurveStyle::line ? right : strokes.dash + strokes.dash_space;
    const double dash = style == CurveStyle::line ? right - sample.left : strokes.dash;
    for (double x = sample.left; x < right; x += step)
      draw_line(painter, x, sample.y, std::min(x + dash, right), sample.y);
    return;
  }
  if (style == CurveStyle::band) colour = tint(colour, band_tint);
  set_fill(painter, colour);
  if (style == CurveStyle::band)
    painter.DrawRect(
        static_cast<float>(sample.left), static_cast<float>(sample.y - strokes.sample_height / 2.),
        static_cast<float>(strokes.sample_width), static_cast<float>(strokes.sample_height));
  else
    painter.DrawEllipse(static_cast<float>((sample.left + right) / 2.),
                        static_cast<float>(sample.y), static_cast<float>(strokes.point / 2.),
                        static_cast<float>(strokes.point / 2.));
}

}  // namespace

vtkStandardNewMacro(PagePainter);

void PagePainter::show(const Figure& figure, const PageLayout& page) {
  figure_ = &figure;
  page_ = &page;
}

bool PagePainter::Paint(vtkContext2D* painter) {
  assert(painter && figure_ && page_);
  for (std::size_t p = 0; p < page_->panels.size(); ++p) {
    const PanelPainter panel(*painter, page_->strokes, page_->panels[p]);
    panel.paint_grid(true);
    panel.paint_grid(false);
    panel.paint_frame();
    for (const LegendSample& sample : page_->panels[p].legend)
      paint_sample(*painter, page_->strokes, figure_->panels[p], sample);
  }
  for (const PlacedText& text : page_->texts) paint_text(*painter, text);
  return true;
}

}  // namespace vibrissa::report
