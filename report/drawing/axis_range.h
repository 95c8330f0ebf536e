#pragma once

#include <vector>

#include "report/drawing/page_layout.h"
#include "report/figures/figure.h"

namespace vibrissa::report {

/// Sets scale and range of the axes of all panels: the given range; default: the range of the
/// finite values. Neighbours with the same x label and nearly the same x range get the same x
/// range. y gets a margin of 5 %.
void set_ranges(const Figure& figure, std::vector<PanelLayout>& panels);

/// Whether two neighbours have the same x axis, so that one set of numbers serves both.
bool share_x_axis(const Panel& a, const PanelLayout& placed_a, const Panel& b,
                  const PanelLayout& placed_b);

}  // namespace vibrissa::report
