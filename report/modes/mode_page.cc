#include "report/modes/mode_page.h"

#include <vtkContext2D.h>
#include <vtkObjectFactory.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "report/drawing/context_painting.h"
#include "report/figures/colour_map.h"
#include "signals/base/number_text.h"

namespace vibrissa::report {
namespace {

constexpr int title_size = 20, label_size = 16, tick_size = 15;
constexpr double margin = 20., title_row = 30., row = 24.;
constexpr double longest_side = 860., shortest_side = 330.;
constexpr double column_width = 210., bar_width = 22., compass_length = 42.;

/// Sides of the box for the mesh, within limits.
Box mesh_box(const MeshView& view) {
  const double aspect = std::clamp(view.width / view.height, 0.01, 100.);
  Box box{margin, margin, longest_side, longest_side};
  if (aspect < 1.)
    box.width = std::max(longest_side * aspect, shortest_side);
  else
    box.height = std::max(longest_side / aspect, shortest_side + 200.);
  return box;
}

std::string scale_text(const double scale) {
  if (scale == 1.) return "deformation to scale";
  return "deformation \u00d7 " + signals::to_text(scale);
}

void magnify(ModePage& page, const int zoom) {
  const auto times_zoom = [&](auto&... values) { ((values *= zoom), ...); };
  times_zoom(page.width, page.height, page.pen, page.compass_x, page.compass_y,
             page.compass_length);
  for (Box* box : {&page.mesh, &page.bar})
    times_zoom(box->left, box->bottom, box->width, box->height);
  for (PlacedText& text : page.texts) times_zoom(text.x, text.y, text.size);
}

/// The column right of the mesh, filled from top to bottom.
void add_column(ModePage& page, const ModePicture& picture, const DeformedMesh& mesh,
                const TextWidth& width) {
  const double left = page.mesh.right() + margin;
  double y = page.mesh.top() - row;
  for (const auto& line :
       wrapped(picture.colour_label, column_width - margin, label_size, false, width)) {
    page.texts.push_back({line, left, y, label_size});
    y -= row;
  }
  page.bar_axis.range = colour_range(mesh.colours);
  page.bar_axis.ticks = linear_ticks(page.bar_axis.range, 6);
  if (page.bar_axis.ticks.exponent != 0) {
    page.texts.push_back(
        {"\u00d7" + power_of_ten(page.bar_axis.ticks.exponent), left, y, tick_size});
    y -= row;
  }
  const double height = 0.42 * page.mesh.height;
  page.bar = {left, y - height, bar_width, height};
  for (const Tick& mark : page.bar_axis.ticks.marks)
    page.texts.push_back({mark.label, page.bar.right() + 12.,
                          page.bar.bottom + height * page.bar_axis.part(mark.at), tick_size});
  page.compass_x = left + compass_length + 6.;
  page.compass_y = page.mesh.bottom + 2. * row + compass_length;
  page.compass_length = compass_length;
  page.texts.push_back({scale_text(mesh.scale), left, page.mesh.bottom + row / 2., tick_size});
}

}  // namespace

vtkStandardNewMacro(ModePagePainter);

ModePage mode_page(const ModePicture& picture, const DeformedMesh& mesh, const MeshView& view,
                   const TextWidth& text_width, const int zoom) {
  ModePage page;
  page.mesh = mesh_box(view);
  page.width = static_cast<int>(std::ceil(page.mesh.right() + column_width + margin));
  const auto lines = wrapped(picture.title, page.width - 2. * margin, title_size, true, text_width);
  const double title_height = static_cast<double>(lines.size()) * title_row;
  page.height = static_cast<int>(std::ceil(page.mesh.top() + title_height + margin));
  double y = page.height - margin - title_row / 2.;
  for (const auto& line : lines) {
    page.texts.push_back({line, page.width / 2., y, title_size, Anchor::centre, true});
    y -= title_row;
  }
  add_column(page, picture, mesh, text_width);
  magnify(page, zoom);
  return page;
}

void ModePagePainter::show(const ModePage& page, const MeshView& view,
                           vtkSmartPointer<vtkLookupTable> colours) {
  page_ = page;
  view_ = view;
  colours_ = std::move(colours);
}

bool ModePagePainter::Paint(vtkContext2D* painter) {
  assert(painter && colours_);
  paint_bar(*painter);
  paint_compass(*painter);
  for (const PlacedText& text : page_.texts) paint_text(*painter, text);
  return true;
}

void ModePagePainter::paint_bar(vtkContext2D& painter) const {
  const Box& bar = page_.bar;
  const auto n = colours_->GetNumberOfTableValues();
  const double step = bar.height / static_cast<double>(n);
  for (vtkIdType i = 0; i < n; ++i) {
    const double* rgba = colours_->GetTableValue(i);
    Colour colour;
    for (std::size_t c = 0; c < colour.size(); ++c)
      colour[c] = static_cast<unsigned char>(std::lround(255. * rgba[c]));
    set_fill(painter, colour);
    // Slightly higher than the step, so that no gap is visible.
    painter.DrawRect(static_cast<float>(bar.left),
                     static_cast<float>(bar.bottom + static_cast<double>(i) * step),
                     static_cast<float>(bar.width),
                     static_cast<float>(i + 1 < n ? 1.5 * step : step));
  }
  set_pen(painter, {110, 110, 110}, page_.pen);
  for (const Tick& mark : page_.bar_axis.ticks.marks) {
    const double y = bar.bottom + bar.height * page_.bar_axis.part(mark.at);
    draw_line(painter, bar.right(), y, bar.right() + 6. * page_.pen, y);
  }
}

void ModePagePainter::paint_compass(vtkContext2D& painter) const {
  const std::array<const char*, 3> names = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    const double dx = view_.right[axis], dy = view_.up[axis];
    const double length = page_.compass_length, beyond = length + 11. * page_.pen;
    set_pen(painter,
            palette_colour(static_cast<std::size_t>(axis == 0   ? 1
                                                    : axis == 1 ? 2
                                                                : 0)),
            2. * page_.pen);
    draw_line(painter, page_.compass_x, page_.compass_y, page_.compass_x + length * dx,
              page_.compass_y + length * dy);
    const double size = std::max(std::hypot(dx, dy), 0.2);
    paint_text(painter, {names[static_cast<std::size_t>(axis)],
                         page_.compass_x + beyond * dx / size * std::hypot(dx, dy),
                         page_.compass_y + beyond * dy / size * std::hypot(dx, dy),
                         static_cast<int>(tick_size * page_.pen), Anchor::centre});
  }
}

}  // namespace vibrissa::report
