#pragma once

#include "report/drawing/picture_file.h"
#include "report/figures/figure.h"

namespace vibrissa::report {

/// A band has the colour of its curve mixed with white.
inline constexpr double band_tint = 0.3;

/// The figure as a picture of 1200 x 400 pixels per panel. Curves with more than many_points points
/// are reduced to the visible points (envelope.h). The figure must outlive the picture. Throws
/// UserError for a figure that fails check(). Proven by tests/report/drawing/draw_test.cc.
Picture picture_of(const Figure& figure);

inline constexpr std::size_t many_points = 4000;

}  // namespace vibrissa::report
