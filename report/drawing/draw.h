#pragma once

#include <filesystem>

#include "report/figures/figure.h"

namespace vibrissa::report {

/// Draws the figure to a PNG file with 1200 x 400 pixels per panel and to an SVG file of the same
/// size. Curves with more than many_points points are reduced to the visible points (envelope.h).
/// Needs a display, else VTK aborts the program: see draw_pictures(). Throws UserError for a figure
/// that fails check() and for files that cannot be written. Proven by
/// tests/report/drawing/draw_test.cc.
void draw_figure(const Figure& figure, const std::filesystem::path& png,
                 const std::filesystem::path& svg);

inline constexpr std::size_t many_points = 4000;

}  // namespace vibrissa::report
