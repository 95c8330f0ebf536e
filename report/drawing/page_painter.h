#pragma once

#include <vtkContextItem.h>

#include "report/drawing/page_layout.h"
#include "report/figures/figure.h"
#include "report/figures/palette.h"

namespace vibrissa::report {

/// A band has the colour of its curve mixed with white.
inline constexpr double band_tint = 0.3;

/// Paints everything on a page except the curves: texts, legend samples, grids, frames and ticks.
/// Figure and page must outlive the painter.
class PagePainter : public vtkContextItem {
 public:
  static PagePainter* New();
  vtkTypeMacro(PagePainter, vtkContextItem);
  PagePainter(const PagePainter&) = delete;
  void operator=(const PagePainter&) = delete;

  void show(const Figure& figure, const PageLayout& page);
  bool Paint(vtkContext2D* painter) override;

 protected:
  PagePainter() = default;
  ~PagePainter() override = default;

 private:
  const Figure* figure_ = nullptr;
  const PageLayout* page_ = nullptr;
};

}  // namespace vibrissa::report
