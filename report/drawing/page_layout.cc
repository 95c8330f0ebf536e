#include "report/drawing/page_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/drawing/axis_range.h"

namespace vibrissa::report {
namespace {

constexpr int title_size = 20, heading_size = 17, label_size = 17, tick_size = 15, legend_size = 15;
constexpr double margin = 14., right_margin = 36., row = 26., title_row = 32.;
constexpr double tick_gap = 10.;  // between an axis and its tick labels
constexpr double gap_between_panels = 16., gap_in_legend = 26., gap_after_sample = 7.;
constexpr double gap_after_heading = 50., least_plot_height = 150.;

/// Estimated plot height for the tick labels of the y axes. The true height depends on the legends,
/// these on the left edge, and this on the tick labels, which hardly depend on the height.
constexpr double usual_plot_height = 0.7 * panel_height;

bool is_in_degrees(const std::string& label) {
  return label.find("\u00b0") != std::string::npos;
}

/// Does the legend of a contain all entries of the legend of b?
bool covers(const Panel& a, const Panel& b) {
  for (std::size_t c = 0; c < b.curves.size(); ++c) {
    bool found = b.curves[c].label.empty();
    for (std::size_t d = 0; d < a.curves.size(); ++d)
      found |= a.curves[d].label == b.curves[c].label && a.curves[d].style == b.curves[c].style &&
               colour_number(a, d) == colour_number(b, c);
    if (!found) return false;
  }
  return true;
}

/// Builds one page; build() calls the steps in the order of their dependence.
class PageBuilder {
 public:
  PageBuilder(const Figure& figure, const TextWidth& width)
      : figure_(figure), width_(width), n_(figure.panels.size()), heading_rows_(n_, 0) {
    page_.width = page_width;
    page_.height = panel_height * static_cast<int>(n_);
    page_.panels.resize(n_);
  }

  PageLayout build() {
    set_ranges(figure_, page_.panels);
    set_left_edges();
    for (std::size_t p = 0; p < n_; ++p)
      set_ticks(panel(p).x, figure_.panels[p].x_label, panel(p).plot.width, 90.);
    for (std::size_t p = 0; p < n_; ++p) place_heading(p);
    stack();
    for (std::size_t p = 0; p < n_; ++p) {
      write_x_axis(p);
      write_y_axis(p);
    }
    return std::move(page_);
  }

 private:
  PanelLayout& panel(const std::size_t p) { return page_.panels[p]; }

  std::vector<std::string> y_label_lines(const std::size_t p) const {
    return wrapped(figure_.panels[p].y_label, usual_plot_height, label_size, false, width_);
  }
  std::vector<std::string> x_label_lines(const std::size_t p) const {
    return wrapped(figure_.panels[p].x_label, page_.panels[p].plot.width, label_size, false,
                   width_);
  }

  static void set_ticks(Axis& axis, const std::string& label, const double length,
                        const double spacing) {
    const int n_most = std::max(2, static_cast<int>(length / spacing));
    axis.ticks = axis.logarithmic ? logarithmic_ticks(axis.range, n_most)
                                  : linear_ticks(axis.range, n_most, is_in_degrees(label));
  }

  static void set_names(Axis& axis, const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < names.size(); ++i)
      axis.ticks.marks.push_back({static_cast<double>(i + 1), names[i]});
  }

  double widest_number(const Axis& axis) const {
    double widest = 0.;
    for (const Tick& mark : axis.ticks.marks)
      widest = std::max(widest, width_(mark.label, tick_size, false));
    if (axis.ticks.exponent == 0) return widest;
    return std::max(widest, width_(factor(axis), tick_size, false));
  }

  static std::string factor(const Axis& axis) {
    return "\u00d7" + power_of_ten(axis.ticks.exponent);
  }

  void set_left_edges() {
    double left = 0.;
    for (std::size_t p = 0; p < n_; ++p) {
      Axis& y = panel(p).y;
      const bool few = y.logarithmic || is_in_degrees(figure_.panels[p].y_label);
      if (figure_.panels[p].y_names.empty())
        set_ticks(y, figure_.panels[p].y_label, usual_plot_height, few ? 48. : 36.);
      else
        set_names(y, figure_.panels[p].y_names);
      left = std::max(left, margin + static_cast<double>(y_label_lines(p).size()) * row + tick_gap +
                                widest_number(y));
    }
    for (PanelLayout& placed : page_.panels) {
      placed.plot.left = left;
      placed.plot.width = page_.width - left - right_margin;
    }
  }

  double legend_length(const std::string& label) const {
    return label.empty() ? 0.
                         : page_.strokes.sample_width + gap_after_sample +
                               width_(label, legend_size, false) + gap_in_legend;
  }

  /// Places heading and legend in rows above the axes; y counts downward from the panel's top at
  /// this step. A legend that fits is beside the heading, right-aligned with the axes.
  void place_heading(const std::size_t p) {
    const Panel& given = figure_.panels[p];
    int& n_rows = heading_rows_[p];
    n_rows = panel(p).y.ticks.exponent != 0 || !given.title.empty();
    if (p > 0 && covers(figure_.panels[p - 1], given)) return;
    double total = -gap_in_legend;
    for (const Curve& curve : given.curves) total += legend_length(curve.label);
    if (total <= 0.) return;
    const Box& plot = panel(p).plot;
    double left = plot.left;
    if (!given.title.empty()) {
      const bool beside =
          left + width_(given.title, heading_size, true) + gap_after_heading + total <=
          plot.right();
      beside ? left = plot.right() - total : ++n_rows;
    }
    n_rows = std::max(n_rows, 1);
    for (std::size_t c = 0; c < given.curves.size(); ++c) {
      const double length = legend_length(given.curves[c].label);
      if (length == 0.) continue;
      if (left + length - gap_in_legend > plot.right() + 0.5 && left > plot.left) {
        ++n_rows;
        left = plot.left;
      }
      panel(p).legend.push_back({c, left, (n_rows - 0.5) * row});
      left += length;
    }
  }

  bool is_x_labelled(const std::size_t p) {
    return p + 1 == n_ ||
           !share_x_axis(figure_.panels[p], panel(p), figure_.panels[p + 1], panel(p + 1));
  }
  double height_below(const std::size_t p) {
    if (!is_x_labelled(p)) return 0.;
    return tick_gap + row * (1. + static_cast<double>(x_label_lines(p).size()));
  }

  /// Gives all plots the same height, from the top of the page down.
  void stack() {
    const auto titles = wrapped(figure_.title, page_.width - 2. * margin, title_size, true, width_);
    double used = 2. * margin + static_cast<double>(titles.size()) * title_row +
                  gap_between_panels * static_cast<double>(n_ - 1);
    for (std::size_t p = 0; p < n_; ++p) used += heading_rows_[p] * row + height_below(p);
    const double least = used + static_cast<double>(n_) * least_plot_height;
    page_.height = std::max(page_.height, static_cast<int>(std::ceil(least)));
    const double plot_height = (page_.height - used) / static_cast<double>(n_);

    double top = page_.height - margin;
    for (const auto& line : titles) {
      write(line, page_.width / 2., top - title_row / 2., title_size, Anchor::centre, true);
      top -= title_row;
    }
    for (std::size_t p = 0; p < n_; ++p) {
      write_heading(p, top);
      panel(p).plot.height = plot_height;
      panel(p).plot.bottom = top - heading_rows_[p] * row - plot_height;
      top = panel(p).plot.bottom - height_below(p) - gap_between_panels;
    }
  }

  void write_heading(const std::size_t p, const double top) {
    write(figure_.panels[p].title, panel(p).plot.left, top - row / 2., heading_size, Anchor::left,
          true);
    for (LegendSample& sample : panel(p).legend) {
      sample.y = top - sample.y;
      write(figure_.panels[p].curves[sample.curve].label,
            sample.left + page_.strokes.sample_width + gap_after_sample, sample.y, legend_size);
    }
  }

  void write_x_axis(const std::size_t p) {
    if (!is_x_labelled(p)) return;
    const PanelLayout& placed = panel(p);
    const Box& plot = placed.plot;
    double y = plot.bottom - tick_gap - row / 2.;
    double free_from = -std::numeric_limits<double>::infinity();
    for (const Tick& mark : placed.x.ticks.marks) {
      const double half = width_(mark.label, tick_size, false) / 2.;
      const double x = std::min(plot.left + plot.width * placed.x.part(mark.at),
                                page_.width - margin / 2. - half);
      if (mark.label.empty() || x - half < free_from) continue;
      write(mark.label, x, y, tick_size, Anchor::centre);
      free_from = x + half + 4.;
    }
    for (const auto& line : x_label_lines(p))
      write(line, plot.left + plot.width / 2., y -= row, label_size, Anchor::centre);
    if (placed.x.ticks.exponent != 0)
      write(factor(placed.x), plot.right(), plot.bottom - tick_gap - 1.5 * row, tick_size,
            Anchor::right);
  }

  void write_y_axis(const std::size_t p) {
    const PanelLayout& placed = panel(p);
    const Box& plot = placed.plot;
    double free_from = -std::numeric_limits<double>::infinity();
    for (const Tick& mark : placed.y.ticks.marks) {
      const double y = plot.bottom + plot.height * placed.y.part(mark.at);
      if (mark.label.empty() || y < free_from) continue;
      write(mark.label, plot.left - tick_gap, y, tick_size, Anchor::right);
      free_from = y + tick_size;
    }
    double x = margin + row / 2.;
    for (const auto& line : y_label_lines(p)) {
      write(line, x, plot.bottom + plot.height / 2., label_size, Anchor::centre, false, true);
      x += row;
    }
    if (placed.y.ticks.exponent != 0)
      write(factor(placed.y), plot.left - tick_gap, plot.top() + row / 2., tick_size,
            Anchor::right);
  }

  void write(const std::string& text, const double x, const double y, const int size,
             const Anchor anchor = Anchor::left, const bool bold = false,
             const bool upward = false) {
    if (!text.empty()) page_.texts.push_back({text, x, y, size, anchor, bold, upward});
  }

  const Figure& figure_;
  const TextWidth& width_;
  std::size_t n_;
  std::vector<int> heading_rows_;
  PageLayout page_;
};

}  // namespace

double Axis::on_paper(const double value) const {
  if (!std::isfinite(value) || (logarithmic && value <= 0.))
    return std::numeric_limits<double>::quiet_NaN();
  return logarithmic ? std::log10(value) : value;
}

PageLayout lay_out(const Figure& figure, const TextWidth& text_width) {
  return PageBuilder(figure, text_width).build();
}

}  // namespace vibrissa::report
