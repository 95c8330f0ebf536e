#include "report/drawing/clip.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vibrissa::report {
namespace {

constexpr double gap = std::numeric_limits<double>::quiet_NaN();

/// Part of a segment from 0 (its start) to 1 (its end).
struct Piece {
  double from = 0., to = 1.;
  bool empty() const { return from > to; }
};

/// Keeps the part inside the window in one coordinate, which runs from start to end.
void cut(Piece& piece, const double start, const double end, const Range& window) {
  const double change = end - start;
  if (change == 0.) {
    if (!window.contains(start)) piece.to = -1.;
    return;
  }
  const double at_low = (window.low - start) / change, at_high = (window.high - start) / change;
  piece.from = std::max(piece.from, std::min(at_low, at_high));
  piece.to = std::min(piece.to, std::max(at_low, at_high));
}

void add(Polyline& line, const double x, const double y) {
  line.x.push_back(x);
  line.y.push_back(y);
}

double between(const double a, const double b, const double part) {
  return a + part * (b - a);
}

/// A band's edges at x between its points i - 1 and i.
void add_between(Band& result, const Band& band, const std::size_t i, const double x) {
  const double part = (x - band.x[i - 1]) / (band.x[i] - band.x[i - 1]);
  result.x.push_back(x);
  result.low.push_back(between(band.low[i - 1], band.low[i], part));
  result.high.push_back(between(band.high[i - 1], band.high[i], part));
}

}  // namespace

Polyline clip_line(const Polyline& line, const Range& x_window, const Range& y_window) {
  const auto& [x, y] = line;
  Polyline result;
  bool joined = false;  // the last point in result is the start of the next segment
  for (std::size_t i = 1; i < x.size(); ++i) {
    Piece piece;
    const bool whole = std::isfinite(x[i - 1] + y[i - 1] + x[i] + y[i]);
    if (whole) cut(piece, x[i - 1], x[i], x_window);
    if (whole) cut(piece, y[i - 1], y[i], y_window);
    if (!whole || piece.empty()) {
      joined = false;
      continue;
    }
    if (!joined || piece.from > 0.) {
      if (!result.x.empty()) add(result, result.x.back(), gap);
      add(result, between(x[i - 1], x[i], piece.from), between(y[i - 1], y[i], piece.from));
    }
    // The end itself where it is inside, because between() may have a rounding error.
    joined = piece.to == 1.;
    if (joined)
      add(result, x[i], y[i]);
    else
      add(result, between(x[i - 1], x[i], piece.to), between(y[i - 1], y[i], piece.to));
  }
  return result;
}

Polyline clip_points(const Polyline& points, const Range& x_window, const Range& y_window) {
  Polyline result;
  for (std::size_t i = 0; i < points.x.size(); ++i)
    if (x_window.contains(points.x[i]) && y_window.contains(points.y[i]))
      add(result, points.x[i], points.y[i]);
  return result;
}

Band clip_band(const Band& band, const Range& x_window, const Range& y_window) {
  Band result;
  for (std::size_t i = 0; i < band.x.size(); ++i) {
    for (const double edge : {x_window.low, x_window.high})
      if (i > 0 && band.x[i - 1] < edge && edge < band.x[i]) add_between(result, band, i, edge);
    if (!x_window.contains(band.x[i])) continue;
    result.x.push_back(band.x[i]);
    result.low.push_back(band.low[i]);
    result.high.push_back(band.high[i]);
  }
  for (auto* edge : {&result.low, &result.high})
    for (double& y : *edge) y = std::clamp(y, y_window.low, y_window.high);
  return result;
}

}  // namespace vibrissa::report
