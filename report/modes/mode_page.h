#pragma once

#include <vtkContextItem.h>
#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>

#include <string>
#include <vector>

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
  double pen = 1.;
  std::vector<PlacedText> texts;
};

/// Layout in pixels, multiplied by zoom. Proven by tests/report/modes/mode_page_test.cc.
ModePage mode_page(const ModePicture& picture, const DeformedMesh& mesh, const MeshView& view,
                   const TextWidth& text_width, int zoom);

/// Paints a ModePage without the mesh itself.
class ModePagePainter : public vtkContextItem {
 public:
  static ModePagePainter* New();
  vtkTypeMacro(ModePagePainter, vtkContextItem);
  ModePagePainter(const ModePagePainter&) = delete;
  void operator=(const ModePagePainter&) = delete;

  void show(const ModePage& page, const MeshView& view, vtkSmartPointer<vtkLookupTable> colours);
  bool Paint(vtkContext2D* painter) override;

 protected:
  ModePagePainter() = default;
  ~ModePagePainter() override = default;

 private:
  void paint_bar(vtkContext2D& painter) const;
  void paint_compass(vtkContext2D& painter) const;

  ModePage page_;
  MeshView view_;
  vtkSmartPointer<vtkLookupTable> colours_;
};

}  // namespace vibrissa::report
