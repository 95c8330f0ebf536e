#include "report/drawing/axis_range.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vibrissa::report {
namespace {

/// Lowest and highest plot coordinate of all added values.
class Extent {
 public:
  explicit Extent(const Axis& axis) : axis_(axis) {}
  void add(const double value) {
    const double at = axis_.on_paper(value);
    if (!std::isfinite(at)) return;
    low_ = std::min(low_, at);
    high_ = std::max(high_, at);
  }
  /// The range with a margin on both sides, given as a share of the length; 0 .. 1 without any
  /// value.
  Range range(const double margin) const {
    if (low_ > high_) return {0., 1.};
    const double length = high_ - low_;
    if (length > 1e-9 * std::max(std::abs(low_), std::abs(high_)))
      return {low_ - margin * length, high_ + margin * length};
    const double half = axis_.logarithmic ? 0.5 : low_ == 0. ? 1. : 0.1 * std::abs(low_);
    return {low_ - half, high_ + half};
  }

 private:
  const Axis& axis_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
};

Range on_paper(const Axis& axis, const Range& range) {
  return {axis.on_paper(range.low), axis.on_paper(range.high)};
}

bool may_share(const Panel& a, const Panel& b) {
  return a.x_label == b.x_label && a.log_x == b.log_x && !a.x_label.empty();
}

/// The range that the panel asks for; default: the range of its curves.
Range own_x_range(const Panel& panel, const Axis& axis) {
  if (panel.x_range) return on_paper(axis, *panel.x_range);
  Extent extent(axis);
  for (const Curve& curve : panel.curves)
    for (const double x : curve.x) extent.add(x);
  return extent.range(0.);
}

Range both(const Range& a, const Range& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

/// A whole record and a part of it have the same x label but need different axes.
bool is_most_of(const Range& part, const Range& whole) {
  return part.length() >= 0.8 * whole.length();
}

/// Neighbours with nearly the same x range get the same range.
void join_x_ranges(const Figure& figure, std::vector<PanelLayout>& panels) {
  for (std::size_t first = 0, end = 0; first < panels.size(); first = end) {
    Range joint = panels[first].x.range, smallest = joint;
    for (end = first + 1; end < panels.size(); ++end) {
      const Range& next = panels[end].x.range;
      const Range smaller = next.length() < smallest.length() ? next : smallest;
      if (!may_share(figure.panels[first], figure.panels[end]) ||
          !is_most_of(smaller, both(joint, next)))
        break;
      joint = both(joint, next);
      smallest = smaller;
    }
    for (std::size_t p = first; p < end; ++p)
      if (!figure.panels[p].x_range) panels[p].x.range = joint;
  }
}

/// Values left and right of the x range do not count.
void set_y_range(const Panel& panel, PanelLayout& placed) {
  Extent extent(placed.y);
  for (const Curve& curve : panel.curves)
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (!placed.x.range.contains(placed.x.on_paper(curve.x[i]))) continue;
      for (const auto* values : {&curve.y, &curve.y_low, &curve.y_high})
        if (!values->empty()) extent.add((*values)[i]);
    }
  if (!panel.y_names.empty())
    placed.y.range = {0.5, static_cast<double>(panel.y_names.size()) + 0.5};
  else
    placed.y.range = panel.y_range ? on_paper(placed.y, *panel.y_range) : extent.range(0.05);
}

}  // namespace

void set_ranges(const Figure& figure, std::vector<PanelLayout>& panels) {
  for (std::size_t p = 0; p < panels.size(); ++p) {
    panels[p].x.logarithmic = figure.panels[p].log_x;
    panels[p].y.logarithmic = figure.panels[p].log_y;
    panels[p].x.range = own_x_range(figure.panels[p], panels[p].x);
  }
  join_x_ranges(figure, panels);
  for (std::size_t p = 0; p < panels.size(); ++p) set_y_range(figure.panels[p], panels[p]);
}

bool share_x_axis(const Panel& a, const PanelLayout& placed_a, const Panel& b,
                  const PanelLayout& placed_b) {
  return may_share(a, b) && placed_a.x.range == placed_b.x.range;
}

}  // namespace vibrissa::report
