#pragma once

#include "report/figures/envelope.h"
#include "report/figures/range.h"

namespace vibrissa::report {

/// The parts of a line inside a window (Liang and Barsky 1984), with gaps where the line is
/// outside. Implemented here because clipping in SVG files differs between viewers. Proven, as the
/// others, by tests/report/drawing/clip_test.cc.
Polyline clip_line(const Polyline& line, const Range& x_window, const Range& y_window);

/// The points inside the window.
Polyline clip_points(const Polyline& points, const Range& x_window, const Range& y_window);

/// The part of a band inside the window; x must be ascending.
Band clip_band(const Band& band, const Range& x_window, const Range& y_window);

}  // namespace vibrissa::report
