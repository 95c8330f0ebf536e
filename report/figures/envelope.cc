#include "report/figures/envelope.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

namespace vibrissa::report {
namespace {

constexpr double gap = std::numeric_limits<double>::quiet_NaN();

/// Pixel columns are counted from 0; -1 and n_columns are all that lies left and right.
class Columns {
 public:
  Columns(const Range& range, const std::size_t n)
      : low_(range.low),
        width_(range.length() / static_cast<double>(n)),
        n_(static_cast<double>(n)) {
    assert(range.length() > 0. && n > 0);
  }
  long operator()(const double x) const {
    return static_cast<long>(std::clamp(std::floor((x - low_) / width_), -1., n_));
  }

 private:
  double low_, width_, n_;
};

bool never_falls(const std::span<const double> x) {
  double last = -std::numeric_limits<double>::infinity();
  for (const double value : x) {
    if (value < last) return false;
    if (std::isfinite(value)) last = value;
  }
  return true;
}

/// Indices first, lowest, highest, last of a run, in the order of the points and without
/// repetition.
void add_run(Polyline& result, const Polyline& line, const std::size_t begin,
             const std::size_t end) {
  const auto run = std::span(line.y).subspan(begin, end - begin);
  const auto [low, high] = std::minmax_element(run.begin(), run.end());
  std::array<std::size_t, 4> kept = {begin, begin + static_cast<std::size_t>(low - run.begin()),
                                     begin + static_cast<std::size_t>(high - run.begin()), end - 1};
  std::sort(kept.begin(), kept.end());
  const auto last = std::unique(kept.begin(), kept.end());
  for (auto i = kept.begin(); i != last; ++i) {
    result.x.push_back(line.x[*i]);
    result.y.push_back(line.y[*i]);
  }
}

}  // namespace

Polyline envelope(const Polyline& line, const Range& x_range, const std::size_t n_columns) {
  const auto& [x, y] = line;
  assert(x.size() == y.size());
  if (!never_falls(x)) return line;
  const Columns column_of(x_range, n_columns);
  Polyline result;
  for (std::size_t i = 0; i < x.size();) {
    const std::size_t begin = i;
    if (!std::isfinite(y[i])) {
      while (i < x.size() && !std::isfinite(y[i])) ++i;
      result.x.push_back(x[begin]);
      result.y.push_back(gap);
      continue;
    }
    const long column = column_of(x[i]);
    while (i < x.size() && std::isfinite(y[i]) && column_of(x[i]) == column) ++i;
    add_run(result, line, begin, i);
  }
  return result;
}

Band band_envelope(const Band& band, const Range& x_range, const std::size_t n_columns) {
  if (!never_falls(band.x)) return band;
  const Columns column_of(x_range, n_columns);
  const auto is_gap = [&](const std::size_t i) {
    return !std::isfinite(band.low[i]) || !std::isfinite(band.high[i]);
  };
  Band result;
  for (std::size_t i = 0; i < band.x.size();) {
    const std::size_t begin = i;
    double low = band.low[i], high = band.high[i];
    const bool gap_run = is_gap(i);
    const long column = column_of(band.x[i]);
    for (++i; i < band.x.size() && is_gap(i) == gap_run; ++i) {
      if (gap_run) continue;
      if (column_of(band.x[i]) != column) break;
      low = std::min(low, band.low[i]);
      high = std::max(high, band.high[i]);
    }
    result.x.push_back(band.x[begin]);
    result.low.push_back(gap_run ? gap : low);
    result.high.push_back(gap_run ? gap : high);
  }
  return result;
}

Polyline one_point_a_pixel(const Polyline& points, const Range& x_range, const Range& y_range,
                           const std::size_t n_columns, const std::size_t n_rows) {
  const Columns column_of(x_range, n_columns), row_of(y_range, n_rows);
  // A point on the upper end of a range is inside the last pixel.
  std::vector<bool> occupied((n_columns + 1) * (n_rows + 1), false);
  Polyline result;
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    if (!x_range.contains(points.x[i]) || !y_range.contains(points.y[i])) continue;
    const auto column = static_cast<std::size_t>(column_of(points.x[i]));
    const auto row = static_cast<std::size_t>(row_of(points.y[i]));
    const auto pixel = row * (n_columns + 1) + column;
    if (occupied[pixel]) continue;
    occupied[pixel] = true;
    result.x.push_back(points.x[i]);
    result.y.push_back(points.y[i]);
  }
  return result;
}

}  // namespace vibrissa::report
