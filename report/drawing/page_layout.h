#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "report/drawing/placed_text.h"
#include "report/figures/figure.h"
#include "report/figures/range.h"
#include "report/figures/ticks.h"

namespace vibrissa::report {

inline constexpr int page_width = 1200, panel_height = 400;  // pixels

/// Pixels, y upward from the lower edge of the page.
struct Box {
  double left = 0., bottom = 0., width = 0., height = 0.;
  double right() const { return left + width; }
  double top() const { return bottom + height; }
};

/// One axis of a panel: what is shown, in the coordinates of the paper.
struct Axis {
  bool logarithmic = false;
  Range range{0., 1.};
  Ticks ticks;

  /// The value, or its decimal logarithm; NaN for what cannot be shown.
  double on_paper(double value) const;
  /// 0 at the lower end of the range, 1 at the upper one.
  double part(double at) const { return (at - range.low) / range.length(); }
};

/// Sample line of a curve in the legend; y is its middle.
struct LegendSample {
  std::size_t curve;
  double left, y;
};

struct PanelLayout {
  Box plot;
  Axis x, y;
  std::vector<LegendSample> legend;
};

/// Widths of pens and the like in pixels.
struct Strokes {
  double line = 2., fine_line = 1.25;  // fine: curves of very many points
  double point = 7.;
  double dash = 9., dash_space = 6.;
  double thin = 1., long_tick = 6., short_tick = 3.;  // grid, frame and tick marks
  double sample_width = 30., sample_height = 12.;     // in the legend
};

struct PageLayout {
  int width = 0, height = 0;
  Strokes strokes;
  std::vector<PanelLayout> panels;
  std::vector<PlacedText> texts;
};

/// Places everything on a page of page_width x n_panels * panel_height (higher only when legends
/// need it): left edges of the panels in line, legends above the axes so that they hide no data and
/// not repeated below one another, long labels in several lines, the x axis labelled once where
/// neighbours share it. Proven by tests/report/drawing/page_layout_test.cc.
PageLayout lay_out(const Figure& figure, const TextWidth& text_width);

/// The same page with everything on it larger by a whole factor.
PageLayout magnified(PageLayout page, int factor);

}  // namespace vibrissa::report
