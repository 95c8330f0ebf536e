#pragma once

#include <cstdint>
#include <vector>

#include "report/drawing/page_layout.h"
#include "report/drawing/placed_text.h"
#include "report/figures/envelope.h"
#include "report/figures/palette.h"

typedef struct _cairo cairo_t;

namespace vibrissa::report {

struct Pen {
  Colour colour{};
  double width = 1.;
  double dash = 0., dash_space = 0.;  // 0: a full line
};

/// Red, green, blue of each pixel, row by row from above.
struct Pixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb{};
};

/// A white page to paint on by Cairo and Pango, in pixels from its lower left corner, y upward.
/// Proven by tests/report/drawing/draw_test.cc.
class Canvas {
 public:
  /// The context must outlive the canvas.
  Canvas(cairo_t& context, int width, int height);

  void line(double x0, double y0, double x1, double y1, const Pen& pen);
  /// Values that are not finite are gaps.
  void polyline(const Polyline& line, const Pen& pen);
  void points(const Polyline& points, const Colour& colour, double diameter);
  void area(const Band& band, const Colour& colour);
  void box(const Box& box, const Colour& colour);
  void text(const PlacedText& placed);
  /// Fills the box, which has the picture's proportions.
  void picture(const Pixels& pixels, const Box& box);

  /// What is painted until its end is seen inside the box alone.
  class Clip {
   public:
    Clip(Canvas& canvas, const Box& box);
    ~Clip();
    Clip(const Clip&) = delete;
    Clip& operator=(const Clip&) = delete;

   private:
    Canvas& canvas_;
  };

 private:
  void set(const Pen& pen);
  void set(const Colour& colour);
  double down(double y) const { return height_ - y; }

  cairo_t& context_;
  double height_;
};

}  // namespace vibrissa::report
