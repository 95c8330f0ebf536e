#include "report/drawing/canvas.h"

#include <cairo.h>
#include <pango/pangocairo.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "report/drawing/lettering.h"

namespace vibrissa::report {
namespace {

constexpr Colour ink = {26, 26, 26};

/// Cairo's coordinates end at 8 million pixels.
double in_reach(const double pixel) {
  constexpr double far = 1e6;
  return std::clamp(pixel, -far, far);
}

}  // namespace

Canvas::Canvas(cairo_t& context, const int width, const int height)
    : context_(context), height_(height) {
  cairo_set_line_join(&context_, CAIRO_LINE_JOIN_ROUND);
  box({0., 0., static_cast<double>(width), height_}, {255, 255, 255});
}

Canvas::Clip::Clip(Canvas& canvas, const Box& box) : canvas_(canvas) {
  cairo_save(&canvas_.context_);
  cairo_rectangle(&canvas_.context_, box.left, canvas_.down(box.top()), box.width, box.height);
  cairo_clip(&canvas_.context_);
}

Canvas::Clip::~Clip() {
  cairo_restore(&canvas_.context_);
}

void Canvas::set(const Colour& colour) {
  cairo_set_source_rgb(&context_, colour[0] / 255., colour[1] / 255., colour[2] / 255.);
}

void Canvas::set(const Pen& pen) {
  set(pen.colour);
  cairo_set_line_width(&context_, pen.width);
  const double lengths[] = {pen.dash, pen.dash_space};
  cairo_set_dash(&context_, lengths, pen.dash > 0. ? 2 : 0, 0.);
}

void Canvas::line(const double x0, const double y0, const double x1, const double y1,
                  const Pen& pen) {
  polyline({{x0, x1}, {y0, y1}}, pen);
}

void Canvas::polyline(const Polyline& line, const Pen& pen) {
  set(pen);
  bool has_begun = false;
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    const bool is_gap = !std::isfinite(line.x[i] + line.y[i]);
    if (!is_gap)
      (has_begun ? cairo_line_to : cairo_move_to)(&context_, in_reach(line.x[i]),
                                                  in_reach(down(line.y[i])));
    has_begun = !is_gap;
  }
  cairo_stroke(&context_);
}

void Canvas::points(const Polyline& points, const Colour& colour, const double diameter) {
  set(Pen{.colour = colour, .width = diameter});
  cairo_save(&context_);
  // A line without length has round ends: a dot, which takes little room in a file.
  cairo_set_line_cap(&context_, CAIRO_LINE_CAP_ROUND);
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    if (!std::isfinite(points.x[i] + points.y[i])) continue;
    cairo_move_to(&context_, in_reach(points.x[i]), in_reach(down(points.y[i])));
    cairo_close_path(&context_);
    cairo_stroke(&context_);
  }
  cairo_restore(&context_);
}

void Canvas::area(const Band& band, const Colour& colour) {
  set(colour);
  const std::size_t n = band.x.size();
  const auto is_gap = [&](std::size_t i) {
    return !std::isfinite(band.x[i] + band.low[i] + band.high[i]);
  };
  for (std::size_t first = 0, end = 0; first < n; first = end + 1) {
    for (end = first; end < n && !is_gap(end);) ++end;
    for (std::size_t i = first; i < end; ++i)
      cairo_line_to(&context_, in_reach(band.x[i]), in_reach(down(band.low[i])));
    for (std::size_t i = end; i > first; --i)
      cairo_line_to(&context_, in_reach(band.x[i - 1]), in_reach(down(band.high[i - 1])));
    cairo_fill(&context_);
  }
}

void Canvas::box(const Box& box, const Colour& colour) {
  set(colour);
  cairo_rectangle(&context_, box.left, down(box.top()), box.width, box.height);
  cairo_fill(&context_);
}

void Canvas::text(const PlacedText& placed) {
  cairo_save(&context_);
  set(ink);
  cairo_translate(&context_, placed.x, down(placed.y));
  if (placed.upward) cairo_rotate(&context_, -0.5 * std::numbers::pi);
  const auto layout = text_layout(placed.text, placed.size, placed.bold);
  int width = 0, height = 0;
  pango_layout_get_size(layout.get(), &width, &height);
  const double anchor = placed.anchor == Anchor::left     ? 0.
                        : placed.anchor == Anchor::centre ? 0.5
                                                          : 1.;
  cairo_move_to(&context_, -anchor * width / PANGO_SCALE, -0.5 * height / PANGO_SCALE);
  pango_cairo_show_layout(&context_, layout.get());
  cairo_restore(&context_);
}

void Canvas::picture(const Pixels& pixels, const Box& box) {
  cairo_surface_t* const surface =
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels.width, pixels.height);
  assert(cairo_surface_status(surface) == CAIRO_STATUS_SUCCESS);
  cairo_surface_flush(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  for (int y = 0; y < pixels.height; ++y) {
    auto* const row =
        reinterpret_cast<std::uint32_t*>(cairo_image_surface_get_data(surface) + y * stride);
    const std::uint8_t* rgb = pixels.rgb.data() + 3 * static_cast<std::size_t>(y) *
                                                      static_cast<std::size_t>(pixels.width);
    for (int x = 0; x < pixels.width; ++x, rgb += 3)
      row[x] = static_cast<std::uint32_t>(rgb[0]) << 16 | static_cast<std::uint32_t>(rgb[1]) << 8 |
               rgb[2];
  }
  cairo_surface_mark_dirty(surface);
  cairo_save(&context_);
  cairo_translate(&context_, box.left, down(box.top()));
  cairo_scale(&context_, box.width / pixels.width, box.height / pixels.height);
  cairo_set_source_surface(&context_, surface, 0., 0.);
  cairo_pattern_set_filter(cairo_get_source(&context_), CAIRO_FILTER_BEST);
  cairo_paint(&context_);
  cairo_restore(&context_);
  cairo_surface_destroy(surface);
}

}  // namespace vibrissa::report
