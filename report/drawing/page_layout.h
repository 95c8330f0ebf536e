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

/// Rectangle in pixels, y upward from the lower edge of the page.
struct Box {
  double left = 0., bottom = 0., width = 0., height = 0.;
  double right() const { return left + width; }
  double top() const { return bottom + height; }
};

/// One axis of a panel in plot coordinates.
struct Axis {
  bool logarithmic = false;
  Range range{0., 1.};
  Ticks ticks;

  /// The value, or its decimal logarithm; NaN for a value that cannot be shown.
  double on_paper(double value) const;
  /// 0 at the lower end of the range, 1 at the upper one.
  double part(double at) const { return (at - range.low) / range.length(); }
};

/// Legend sample of a curve; y is its middle.
struct LegendSample {
  std::size_t curve;
  double left, y;
};

struct PanelLayout {
  Box plot;
  Axis x, y;
  std::vector<LegendSample> legend;
};

/// Pen widths and other lengths in pixels.
struct Strokes {
  double line = 2., fine_line = 1.25;  // fine: curves with very many points
  double point = 7.;
  double dash = 9., dash_space = 6.;
  double thin = 1., long_tick = 6., short_tick = 3.;  // grid, frame and tick marks
  double sample_width = 30., sample_height = 12.;     // of the legend samples
};

struct PageLayout {
  int width = 0, height = 0;
  Strokes strokes;
  std::vector<PanelLayout> panels;
  std::vector<PlacedText> texts;
};

/// Layout of a page of page_width x n_panels * panel_height pixels (higher only when legends need
/// it): left edges of the panels are aligned, legends are above the axes so that they hide no data
/// and are not repeated, long labels have several lines, and neighbours with the same x axis have
/// one x label. Proven by tests/report/drawing/page_layout_test.cc.
PageLayout lay_out(const Figure& figure, const TextWidth& text_width);

}  // namespace vibrissa::report
