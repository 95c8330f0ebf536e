#include "report/drawing/draw.h"

#include <vtkAxis.h>
#include <vtkBrush.h>
#include <vtkChartXY.h>
#include <vtkContextActor.h>
#include <vtkContextScene.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPlotPoints.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTable.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/drawing/band_painter.h"
#include "report/drawing/clip.h"
#include "report/drawing/dashes.h"
#include "report/drawing/lettering.h"
#include "report/drawing/page_layout.h"
#include "report/drawing/page_painter.h"
#include "report/drawing/picture_file.h"
#include "report/figures/envelope.h"

namespace vibrissa::report {
namespace {

/// The charts plot pixels, because scaled axes would distort pens in SVG files, and because single
/// precision would lose a small change on a large value.
std::vector<double> pixels(const Axis& axis, const std::vector<double>& values, const double start,
                           const double length) {
  std::vector<double> result;
  result.reserve(values.size());
  for (const double value : values)
    result.push_back(start + length * axis.part(axis.on_paper(value)));
  return result;
}
std::vector<double> x_pixels(const PanelLayout& placed, const std::vector<double>& values) {
  return pixels(placed.x, values, placed.plot.left, placed.plot.width);
}
std::vector<double> y_pixels(const PanelLayout& placed, const std::vector<double>& values) {
  return pixels(placed.y, values, placed.plot.bottom, placed.plot.height);
}
Range x_window(const Box& plot) {
  return {plot.left, plot.right()};
}
Range y_window(const Box& plot) {
  return {plot.bottom, plot.top()};
}

void add_column(vtkTable& table, const char* name, const std::vector<double>& values) {
  vtkNew<vtkDoubleArray> column;
  column->SetName(name);
  column->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), column->GetPointer(0));
  table.AddColumn(column);
}

/// The visible part of a line or of points. A value without x becomes a gap.
Polyline visible(const Curve& curve, const PanelLayout& placed, const Strokes& strokes) {
  Polyline line{x_pixels(placed, curve.x), y_pixels(placed, curve.y)};
  for (std::size_t i = 0; i < line.x.size(); ++i)
    if (!std::isfinite(line.x[i])) line.y[i] = std::numeric_limits<double>::quiet_NaN();
  const Range x = x_window(placed.plot), y = y_window(placed.plot);
  const bool many = line.x.size() > many_points;
  const auto n_columns = static_cast<std::size_t>(placed.plot.width);
  const auto n_rows = static_cast<std::size_t>(placed.plot.height);
  if (curve.style == CurveStyle::points)
    return many ? one_point_a_pixel(line, x, y, n_columns, n_rows) : clip_points(line, x, y);
  line = clip_line(many ? envelope(line, x, n_columns) : line, x, y);
  return curve.style == CurveStyle::dashed ? dashes(line, strokes.dash, strokes.dash_space) : line;
}

void add_line(vtkChartXY& chart, const Panel& panel, const std::size_t c, const PanelLayout& placed,
              const Strokes& strokes) {
  const Curve& curve = panel.curves[c];
  const Polyline line = visible(curve, placed, strokes);
  if (line.x.empty()) return;
  vtkNew<vtkTable> table;
  add_column(*table, "x", line.x);
  add_column(*table, "y", line.y);
  const bool points = curve.style == CurveStyle::points;
  vtkPlot* plot = chart.AddPlot(points ? vtkChart::POINTS : vtkChart::LINE);
  plot->SetInputData(table, 0, 1);
  const Colour colour = palette_colour(colour_number(panel, c));
  plot->SetColor(colour[0], colour[1], colour[2], 255);
  const bool fine = curve.style == CurveStyle::line && curve.x.size() > many_points;
  plot->SetWidth(static_cast<float>(fine ? strokes.fine_line : strokes.line));
  if (!points) return;
  auto* marked = vtkPlotPoints::SafeDownCast(plot);
  marked->SetMarkerStyle(vtkPlotPoints::CIRCLE);
  marked->SetMarkerSize(static_cast<float>(strokes.point));
}

void add_bands(BandPainter& painter, const Panel& panel, const PanelLayout& placed) {
  const Range window = x_window(placed.plot);
  for (std::size_t c = 0; c < panel.curves.size(); ++c) {
    const Curve& curve = panel.curves[c];
    if (curve.style != CurveStyle::band) continue;
    Band band{x_pixels(placed, curve.x), y_pixels(placed, curve.y_low),
              y_pixels(placed, curve.y_high)};
    if (band.x.size() > many_points)
      band = band_envelope(band, window, static_cast<std::size_t>(placed.plot.width));
    painter.add(clip_band(band, window, y_window(placed.plot)),
                tint(palette_colour(colour_number(panel, c)), band_tint));
  }
}

/// Hides the chart's axis, because the page draws it.
void set_axes(vtkChartXY& chart, const Box& plot) {
  for (const int position : {vtkAxis::LEFT, vtkAxis::BOTTOM, vtkAxis::RIGHT, vtkAxis::TOP}) {
    vtkAxis* axis = chart.GetAxis(position);
    axis->SetAxisVisible(false);
    axis->SetGridVisible(false);
    axis->SetLabelsVisible(false);
    axis->SetTicksVisible(false);
    axis->SetTitle("");
    axis->SetBehavior(vtkAxis::FIXED);
    const bool upward = position == vtkAxis::LEFT || position == vtkAxis::RIGHT;
    const Range window = upward ? y_window(plot) : x_window(plot);
    axis->SetRange(window.low, window.high);
  }
}

vtkNew<vtkChartXY> chart_of(const Panel& panel, const PanelLayout& placed, const Strokes& strokes) {
  vtkNew<vtkChartXY> chart;
  chart->SetShowLegend(false);
  chart->SetHiddenAxisBorder(0);
  chart->SetLayoutStrategy(vtkChart::AXES_TO_RECT);
  chart->GetBackgroundBrush()->SetOpacity(0);
  const Box& plot = placed.plot;
  chart->SetSize(vtkRectf(static_cast<float>(plot.left), static_cast<float>(plot.bottom),
                          static_cast<float>(plot.width), static_cast<float>(plot.height)));
  set_axes(*chart, plot);
  for (std::size_t c = 0; c < panel.curves.size(); ++c)
    if (panel.curves[c].style != CurveStyle::band) add_line(*chart, panel, c, placed, strokes);
  return chart;
}

/// A window with the page drawn on it; figure and page must outlive it.
vtkNew<vtkRenderWindow> window_with(const Figure& figure, const PageLayout& page) {
  vtkNew<vtkContextActor> actor;
  vtkNew<PagePainter> painter;
  painter->show(figure, page);
  actor->GetScene()->AddItem(painter);
  vtkNew<BandPainter> bands;  // painted first, below all other curves
  for (std::size_t p = 0; p < figure.panels.size(); ++p)
    add_bands(*bands, figure.panels[p], page.panels[p]);
  actor->GetScene()->AddItem(bands);
  for (std::size_t p = 0; p < figure.panels.size(); ++p)
    actor->GetScene()->AddItem(chart_of(figure.panels[p], page.panels[p], page.strokes));
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1., 1., 1.);
  renderer->SetBackgroundAlpha(1.);
  renderer->AddActor(actor);
  actor->GetScene()->SetRenderer(renderer);
  vtkNew<vtkRenderWindow> window;
  window->AddRenderer(renderer);
  prepare_offscreen(*window, page.width, page.height);
  return window;
}

}  // namespace

void draw_figure(const Figure& figure, const std::filesystem::path& png,
                 const std::filesystem::path& svg) {
  check(figure);
  const PageLayout page = lay_out(figure, text_width), large = magnified(page, oversampling);
  const auto large_window = window_with(figure, large);
  write_png(*large_window, png);
  const auto window = window_with(figure, page);
  window->Render();
  write_svg(*window, svg, figure.title, figure.caption);
}

}  // namespace vibrissa::report
