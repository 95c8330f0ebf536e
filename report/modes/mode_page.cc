#include "report/modes/mode_page.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "report/modes/colour_map.h"
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

void paint_bar(Canvas& canvas, const ModePage& page, const std::span<const Colour> colours) {
  const Box& bar = page.bar;
  const double step = bar.height / static_cast<double>(colours.size());
  // Each reaches under the next one, so that no gap is visible.
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const double part = static_cast<double>(i) * step;
    canvas.box({bar.left, bar.bottom + part, bar.width, std::min(1.5 * step, bar.height - part)},
               colours[i]);
  }
  for (const Tick& mark : page.bar_axis.ticks.marks) {
    const double y = bar.bottom + bar.height * page.bar_axis.part(mark.at);
    canvas.line(bar.right(), y, bar.right() + 6., y, {.colour = {110, 110, 110}});
  }
}

void paint_compass(Canvas& canvas, const ModePage& page, const MeshView& view) {
  constexpr std::array names = {"x", "y", "z"};
  constexpr std::array<std::size_t, 3> colours = {1, 2, 0};
  for (std::size_t axis = 0; axis < names.size(); ++axis) {
    const double dx = view.right[static_cast<Eigen::Index>(axis)],
                 dy = view.up[static_cast<Eigen::Index>(axis)];
    const double length = page.compass_length, beyond = length + 11.;
    canvas.line(page.compass_x, page.compass_y, page.compass_x + length * dx,
                page.compass_y + length * dy,
                {.colour = palette_colour(colours[axis]), .width = 2.});
    const double seen = std::hypot(dx, dy), stretch = seen / std::max(seen, 0.2);
    canvas.text({names[axis], page.compass_x + beyond * dx * stretch,
                 page.compass_y + beyond * dy * stretch, tick_size, Anchor::centre});
  }
}

}  // namespace

ModePage mode_page(const ModePicture& picture, const DeformedMesh& mesh, const MeshView& view,
                   const TextWidth& text_width) {
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
  return page;
}

void paint(Canvas& canvas, const ModePage& page, const MeshView& view,
           const std::span<const Colour> colours) {
  paint_bar(canvas, page, colours);
  paint_compass(canvas, page, view);
  for (const PlacedText& text : page.texts) canvas.text(text);
}

}  // namespace vibrissa::report
