#pragma once

#include <span>
#include <vector>

#include "report/drawing/canvas.h"
#include "report/drawing/page_layout.h"
#include "report/drawing/placed_text.h"
#include "report/modes/mesh_view.h"

namespace vibrissa::report {

/// Layout of the picture of a deformed mesh: the mesh, and right of it a colour bar, the directions
/// of the axes and the scale of the deformation.
struct ModePage {
  int width = 0, height = 0;
  Box mesh;
  Box bar;
  Axis bar_axis;
  double compass_x = 0., compass_y = 0., compass_length = 0.;
  std::vector<PlacedText> texts;
};

/// Layout in pixels. Proven by tests/report/modes/mode_page_test.cc.
ModePage mode_page(const ModePicture& picture, const DeformedMesh& mesh, const MeshView& view,
                   const TextWidth& text_width);

/// Paints all but the mesh itself; colours from the lower end of the bar to the upper one.
void paint(Canvas& canvas, const ModePage& page, const MeshView& view,
           std::span<const Colour> colours);

}  // namespace vibrissa::report
