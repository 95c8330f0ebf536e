#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "report/figure.h"
#include "report/range.h"
#include "report/ticks.h"

namespace vibrissa::report {

inline constexpr int page_width = 1200, panel_height = 400;  // pixels

/// Sizes of letters in pixels.
namespace letter {
inline constexpr int title = 20, heading = 17, label = 17, tick = 15, legend = 15;
}

/// Pixels, y upward from the lower edge of the page.
struct Box {
  double left, bottom, width, height;
  double right() const { return left + width; }
  double top() const { return bottom + height; }
};

/// One axis of a panel: what is shown, in the coordinates of the paper.
struct Axis {
  bool logarithmic = false;
  Range range{0., 1.};
  Ticks ticks;
  std::vector<std::string> label_lines;
  bool labelled = true;  // false: the axis of the panel below serves

  /// The value, or its decimal logarithm; NaN for what cannot be shown.
  double on_paper(double value) const;
};

struct LegendEntry {
  std::size_t curve;
  double left, baseline;  // of its sample; the text follows
};

struct PanelLayout {
  Box plot;
  Axis x, y;
  double heading_baseline;
  std::vector<LegendEntry> legend;
};

struct PageLayout {
  int width, height;
  std::vector<std::string> title_lines;
  std::vector<PanelLayout> panels;
};

/// Width of a text in pixels at a letter size.
using TextWidth = std::function<double(const std::string&, int size, bool bold)>;

/// Places everything on a page of page_width x n_panels * panel_height: left edges of the panels in
/// line, legends above the axes so that they hide no data, long titles in several lines, the x axis
/// shown once where neighbours share it. Proven by tests/report/page_layout_test.cc.
PageLayout lay_out(const Figure& figure, const TextWidth& text_width);

inline constexpr double legend_sample_width = 30., legend_gap = 7.;

}  // namespace vibrissa::report
