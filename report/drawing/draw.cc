#include "report/drawing/draw.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/drawing/lettering.h"
#include "report/drawing/page_layout.h"
#include "report/figures/envelope.h"

namespace vibrissa::report {
namespace {

constexpr Colour grid_colour = {221, 221, 221}, fine_grid_colour = {240, 240, 240};
constexpr Colour frame_colour = {110, 110, 110};

std::vector<double> pixels(const Axis& axis, const std::vector<double>& values, const double start,
                           const double length) {
  std::vector<double> result;
  result.reserve(values.size());
  for (const double value : values)
    result.push_back(start + length * axis.part(axis.on_paper(value)));
  return result;
}

/// The middle of a pixel, because a thin line between two pixels would be wide and pale.
double middle(const double pixel) {
  return std::floor(pixel) + 0.5;
}

/// Draws one panel without its texts.
class PanelPainter {
 public:
  PanelPainter(Canvas& canvas, const Strokes& strokes, const Panel& panel,
               const PanelLayout& placed)
      : canvas_(canvas),
        strokes_(strokes),
        panel_(panel),
        placed_(placed),
        left_(middle(placed.plot.left)),
        right_(middle(placed.plot.right())),
        bottom_(middle(placed.plot.bottom)),
        top_(middle(placed.plot.top())) {}

  void paint() {
    paint_grid(true);
    paint_grid(false);
    {
      const Canvas::Clip inside(canvas_, placed_.plot);
      for_each(CurveStyle::band, [&](std::size_t c) { paint_band(c); });
      for (const CurveStyle style : {CurveStyle::line, CurveStyle::dashed})
        for_each(style, [&](std::size_t c) { paint_line(c); });
    }
    paint_frame();
    // A point on the frame is seen whole.
    for_each(CurveStyle::points, [&](std::size_t c) { paint_points(c); });
    for (const LegendSample& sample : placed_.legend) paint_sample(sample);
  }

 private:
  template <typename Paint>
  void for_each(const CurveStyle style, const Paint& paint) {
    for (std::size_t c = 0; c < panel_.curves.size(); ++c)
      if (panel_.curves[c].style == style) paint(c);
  }

  void paint_grid(const bool fine) {
    const Pen pen{.colour = fine ? fine_grid_colour : grid_colour, .width = strokes_.thin};
    for (const Tick& mark : placed_.x.ticks.marks)
      if (mark.label.empty() == fine) canvas_.line(x(mark), bottom_, x(mark), top_, pen);
    for (const Tick& mark : placed_.y.ticks.marks)
      if (mark.label.empty() == fine) canvas_.line(left_, y(mark), right_, y(mark), pen);
  }

  void paint_frame() {
    const Pen pen{.colour = frame_colour, .width = strokes_.thin};
    canvas_.polyline(
        {{left_, right_, right_, left_, left_}, {bottom_, bottom_, top_, top_, bottom_}}, pen);
    for (const Tick& mark : placed_.x.ticks.marks)
      canvas_.line(x(mark), bottom_ - length(mark), x(mark), bottom_, pen);
    for (const Tick& mark : placed_.y.ticks.marks)
      canvas_.line(left_ - length(mark), y(mark), left_, y(mark), pen);
  }

  void paint_band(const std::size_t c) {
    const Curve& curve = panel_.curves[c];
    Band band{x_pixels(curve.x), y_pixels(curve.y_low), y_pixels(curve.y_high)};
    if (band.x.size() > many_points) band = band_envelope(band, x_window(), n_columns());
    canvas_.area(band, tint(colour(c), band_tint));
  }

  void paint_line(const std::size_t c) {
    Polyline line = on_page(panel_.curves[c]);
    const bool many = line.x.size() > many_points;
    if (many) line = envelope(line, x_window(), n_columns());
    canvas_.polyline(line, pen_of(c, many));
  }

  void paint_points(const std::size_t c) {
    Polyline points = on_page(panel_.curves[c]);
    const Range x = x_window(), y{placed_.plot.bottom, placed_.plot.top()};
    if (points.x.size() > many_points)
      points = one_point_a_pixel(points, x, y, n_columns(),
                                 static_cast<std::size_t>(placed_.plot.height));
    for (std::size_t i = 0; i < points.x.size(); ++i)
      if (!x.contains(points.x[i]) || !y.contains(points.y[i]))
        points.y[i] = std::numeric_limits<double>::quiet_NaN();
    canvas_.points(points, colour(c), strokes_.point);
  }

  void paint_sample(const LegendSample& sample) {
    const double right = sample.left + strokes_.sample_width;
    switch (panel_.curves[sample.curve].style) {
      case CurveStyle::line:
      case CurveStyle::dashed:
        canvas_.line(sample.left, sample.y, right, sample.y, pen_of(sample.curve, false));
        break;
      case CurveStyle::points:
        canvas_.points({{(sample.left + right) / 2.}, {sample.y}}, colour(sample.curve),
                       strokes_.point);
        break;
      case CurveStyle::band:
        canvas_.box({sample.left, sample.y - strokes_.sample_height / 2., strokes_.sample_width,
                     strokes_.sample_height},
                    tint(colour(sample.curve), band_tint));
    }
  }

  Pen pen_of(const std::size_t c, const bool many) const {
    const bool dashed = panel_.curves[c].style == CurveStyle::dashed;
    return {.colour = colour(c),
            .width = many && !dashed ? strokes_.fine_line : strokes_.line,
            .dash = dashed ? strokes_.dash : 0.,
            .dash_space = strokes_.dash_space};
  }
  Colour colour(const std::size_t c) const { return palette_colour(colour_number(panel_, c)); }

  /// A value without x becomes a gap.
  Polyline on_page(const Curve& curve) const {
    Polyline line{x_pixels(curve.x), y_pixels(curve.y)};
    for (std::size_t i = 0; i < line.x.size(); ++i)
      if (!std::isfinite(line.x[i])) line.y[i] = std::numeric_limits<double>::quiet_NaN();
    return line;
  }
  std::vector<double> x_pixels(const std::vector<double>& values) const {
    return pixels(placed_.x, values, placed_.plot.left, placed_.plot.width);
  }
  std::vector<double> y_pixels(const std::vector<double>& values) const {
    return pixels(placed_.y, values, placed_.plot.bottom, placed_.plot.height);
  }
  Range x_window() const { return {placed_.plot.left, placed_.plot.right()}; }
  std::size_t n_columns() const { return static_cast<std::size_t>(placed_.plot.width); }

  double x(const Tick& mark) const {
    return middle(placed_.plot.left + placed_.plot.width * placed_.x.part(mark.at));
  }
  double y(const Tick& mark) const {
    return middle(placed_.plot.bottom + placed_.plot.height * placed_.y.part(mark.at));
  }
  double length(const Tick& mark) const {
    return mark.label.empty() ? strokes_.short_tick : strokes_.long_tick;
  }

  Canvas& canvas_;
  const Strokes& strokes_;
  const Panel& panel_;
  const PanelLayout& placed_;
  double left_, right_, bottom_, top_;
};

}  // namespace

Picture picture_of(const Figure& figure) {
  check(figure);
  const PageLayout page = lay_out(figure, text_width);
  return {.width = page.width,
          .height = page.height,
          .title = figure.title,
          .caption = figure.caption,
          .paint = [&figure, page](Canvas& canvas) {
            for (std::size_t p = 0; p < page.panels.size(); ++p)
              PanelPainter(canvas, page.strokes, figure.panels[p], page.panels[p]).paint();
            for (const PlacedText& text : page.texts) canvas.text(text);
          }};
}

}  // namespace vibrissa::report
