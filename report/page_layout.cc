#include "report/page_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace vibrissa::report {
namespace {

constexpr double margin = 14., right_margin = 32., row = 26., tick_gap = 12.;
constexpr double gap_between_panels = 16., legend_entry_gap = 26., title_row = 32.;
constexpr double heading_gap = 50., baseline_drop = 18., least_plot_height = 150.;

/// Plot heights need the legends' rows, these the left edge, and that the ticks of y, which hardly
/// depend on the height: this guess serves for them.
constexpr double usual_plot_height = 0.7 * panel_height;

/// Breaks at blanks so that each line is at most width wide, unless a single word is wider.
std::vector<std::string> wrapped(const std::string& text, const double width,
                                 const std::function<double(const std::string&)>& width_of) {
  std::vector<std::string> lines;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!lines.empty() && width_of(lines.back() + " " + word) <= width)
      lines.back() += " " + word;
    else
      lines.push_back(word);
  }
  return lines;
}

/// Lowest and highest finite value on paper, over everything added.
class Extent {
 public:
  explicit Extent(const Axis& axis) : axis_(axis) {}
  void add(const std::vector<double>& values) {
    for (const double value : values) {
      const double at = axis_.on_paper(value);
      if (!std::isfinite(at)) continue;
      low_ = std::min(low_, at);
      high_ = std::max(high_, at);
    }
  }
  /// With a margin on both sides as part of the length; 0 .. 1 without any value.
  Range range(const double part) const {
    if (low_ > high_) return {0., 1.};
    const double length = high_ - low_;
    if (length > 1e-9 * std::max(std::abs(low_), std::abs(high_)))
      return {low_ - part * length, high_ + part * length};
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

bool share_x(const Panel& a, const Panel& b) {
  return a.x_label == b.x_label && a.log_x == b.log_x && !a.x_label.empty();
}

/// x ranges: the panel's own, else what all neighbours that share the axis need.
void set_x_ranges(const Figure& figure, std::vector<PanelLayout>& panels) {
  const std::size_t n = panels.size();
  for (std::size_t first = 0, last = 0; first < n; first = last + 1) {
    for (last = first; last + 1 < n && share_x(figure.panels[first], figure.panels[last + 1]);)
      ++last;
    Axis& axis = panels[first].x;
    axis.logarithmic = figure.panels[first].log_x;
    Extent extent(axis);
    for (std::size_t p = first; p <= last; ++p)
      for (const Curve& curve : figure.panels[p].curves) extent.add(curve.x);
    for (std::size_t p = first; p <= last; ++p) {
      panels[p].x.logarithmic = axis.logarithmic;
      const auto& given = figure.panels[p].x_range;
      panels[p].x.range = given ? on_paper(axis, *given) : extent.range(0.);
    }
    for (std::size_t p = first; p < last; ++p)
      panels[p].x.labelled = !(panels[p].x.range == panels[p + 1].x.range);
  }
}

void set_y_range(const Panel& panel, Axis& axis) {
  axis.logarithmic = panel.log_y;
  Extent extent(axis);
  for (const Curve& curve : panel.curves)
    for (const auto* values : {&curve.y, &curve.y_low, &curve.y_high}) extent.add(*values);
  axis.range = panel.y_range ? on_paper(axis, *panel.y_range) : extent.range(0.05);
}

bool is_in_degrees(const std::string& label) {
  return label.find("\u00b0") != std::string::npos;
}

void set_ticks(Axis& axis, const std::string& label, const double length, const double spacing) {
  const int n_most = std::max(2, static_cast<int>(length / spacing));
  axis.ticks = axis.logarithmic ? logarithmic_ticks(axis.range, n_most)
                                : linear_ticks(axis.range, n_most, is_in_degrees(label));
}

bool same_legend(const Panel& a, const Panel& b) {
  if (a.curves.size() != b.curves.size()) return false;
  for (std::size_t c = 0; c < a.curves.size(); ++c)
    if (a.curves[c].label != b.curves[c].label || a.curves[c].style != b.curves[c].style ||
        a.curves[c].colour != b.curves[c].colour)
      return false;
  return true;
}

/// Rows of legend entries, beside the heading as far as there is room, else below it. Baselines
/// count from the top of the panel downward.
class HeadingRows {
 public:
  HeadingRows(const Panel& panel, const PanelLayout& placed, const bool with_legend,
              const TextWidth& width) {
    if (placed.y.ticks.exponent != 0 || !panel.title.empty()) n_rows_ = 1;
    if (with_legend) place_legend(panel, placed.plot, width);
  }
  int n_rows() const { return n_rows_; }
  const std::vector<LegendEntry>& entries() const { return entries_; }

 private:
  void place_legend(const Panel& panel, const Box& plot, const TextWidth& width) {
    double left = plot.left;
    if (!panel.title.empty()) left += width(panel.title, letter::heading, true) + heading_gap;
    for (std::size_t c = 0; c < panel.curves.size(); ++c) {
      if (panel.curves[c].label.empty()) continue;
      const double length =
          legend_sample_width + legend_gap + width(panel.curves[c].label, letter::legend, false);
      if (n_rows_ == 0 || left + length > plot.right()) {
        ++n_rows_;
        left = plot.left;
      }
      entries_.push_back({c, left, (n_rows_ - 1) * row + baseline_drop});
      left += length + legend_entry_gap;
    }
    // Beside a heading the entries end where the axes do.
    if (n_rows_ == 1 && !panel.title.empty())
      for (LegendEntry& entry : entries_) entry.left += plot.right() + legend_entry_gap - left;
  }
  int n_rows_ = 0;
  std::vector<LegendEntry> entries_;
};

double widest_tick_label(const Axis& axis, const TextWidth& text_width) {
  double widest = 0.;
  for (const Tick& mark : axis.ticks.marks)
    widest = std::max(widest, text_width(mark.label, letter::tick, false));
  if (axis.ticks.exponent != 0)
    widest = std::max(
        widest, text_width("\u00d7" + power_of_ten(axis.ticks.exponent), letter::tick, false));
  return widest;
}

double height_below(const Axis& x) {
  return x.labelled ? tick_gap + row + static_cast<double>(x.label_lines.size()) * row : 0.;
}

/// Fills in the left edge of all plots from the widest y labels.
void set_left_edges(const Figure& figure, PageLayout& page, const TextWidth& text_width) {
  double left = 0.;
  for (std::size_t p = 0; p < page.panels.size(); ++p) {
    Axis& y = page.panels[p].y;
    set_ticks(y, figure.panels[p].y_label, usual_plot_height, 48.);
    y.label_lines =
        wrapped(figure.panels[p].y_label, usual_plot_height,
                [&](const std::string& text) { return text_width(text, letter::label, false); });
    left = std::max(left, margin + static_cast<double>(y.label_lines.size()) * row + tick_gap +
                              widest_tick_label(y, text_width));
  }
  for (PanelLayout& panel : page.panels) {
    panel.plot.left = left;
    panel.plot.width = page.width - left - right_margin;
  }
}

std::vector<HeadingRows> place_headings(const Figure& figure, const PageLayout& page,
                                        const TextWidth& text_width) {
  std::vector<HeadingRows> headings;
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    const bool repeats = p > 0 && same_legend(figure.panels[p - 1], figure.panels[p]);
    headings.emplace_back(figure.panels[p], page.panels[p], !repeats, text_width);
  }
  return headings;
}

void set_x_ticks(const Panel& panel, PanelLayout& placed, const TextWidth& text_width) {
  set_ticks(placed.x, panel.x_label, placed.plot.width, 90.);
  placed.x.label_lines = wrapped(panel.x_label, placed.plot.width, [&](const std::string& text) {
    return text_width(text, letter::label, false);
  });
}

/// Gives all plots the same height, from the top of the page down.
void stack(PageLayout& page, const std::vector<HeadingRows>& headings) {
  const auto n = static_cast<double>(page.panels.size());
  const double title_height = static_cast<double>(page.title_lines.size()) * title_row;
  double used = 2. * margin + title_height + gap_between_panels * (n - 1.);
  for (std::size_t p = 0; p < page.panels.size(); ++p)
    used += headings[p].n_rows() * row + height_below(page.panels[p].x);
  page.height = std::max(page.height, static_cast<int>(std::ceil(used + n * least_plot_height)));
  const double plot_height = (page.height - used) / n;

  double top = page.height - margin - title_height;
  for (std::size_t p = 0; p < page.panels.size(); ++p) {
    PanelLayout& placed = page.panels[p];
    placed.heading_baseline = top - baseline_drop;
    for (LegendEntry entry : headings[p].entries()) {
      entry.baseline = top - entry.baseline;
      placed.legend.push_back(entry);
    }
    placed.plot.height = plot_height;
    placed.plot.bottom = top - headings[p].n_rows() * row - plot_height;
    top = placed.plot.bottom - height_below(placed.x) - gap_between_panels;
  }
}

}  // namespace

double Axis::on_paper(const double value) const {
  if (!std::isfinite(value) || (logarithmic && value <= 0.))
    return std::numeric_limits<double>::quiet_NaN();
  return logarithmic ? std::log10(value) : value;
}

PageLayout lay_out(const Figure& figure, const TextWidth& text_width) {
  const std::size_t n = figure.panels.size();
  PageLayout page{page_width, panel_height * static_cast<int>(n), {}, std::vector<PanelLayout>(n)};
  page.title_lines = wrapped(figure.title, page.width - 2. * margin, [&](const std::string& text) {
    return text_width(text, letter::title, true);
  });
  set_x_ranges(figure, page.panels);
  for (std::size_t p = 0; p < n; ++p) set_y_range(figure.panels[p], page.panels[p].y);
  set_left_edges(figure, page, text_width);
  for (std::size_t p = 0; p < n; ++p) set_x_ticks(figure.panels[p], page.panels[p], text_width);
  stack(page, place_headings(figure, page, text_width));
  return page;
}

}  // namespace vibrissa::report
