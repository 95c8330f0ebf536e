#pragma once

#include <filesystem>

#include "report/figures/figure.h"

namespace vibrissa::report {

/// Draws the figure to a PNG file of 1200 x 400 pixels a panel and to an SVG file of the same size.
/// Curves of more than many_points points are thinned to what can be seen (envelope.h). Needs a
/// display, else VTK aborts the program: see draw_pictures(). Throws UserError for a figure that
/// check() refuses and for files that cannot be written. Proven by
/// tests/report/drawing/draw_test.cc.
void draw_figure(const Figure& figure, const std::filesystem::path& png,
                 const std::filesystem::path& svg);

inline constexpr std::size_t many_points = 4000;

}  // namespace vibrissa::report
