#pragma once

#include <vtkContextItem.h>

#include "report/figure.h"
#include "report/page_layout.h"

namespace vibrissa::report {

/// Everything on a page but the curves and the axes' numbers: titles, axis labels, legends, grids,
/// frames and small tick marks. Both pointers must outlive the painter.
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
  void paint_titles(vtkContext2D& painter) const;
  void paint_panel(vtkContext2D& painter, const Panel& panel, const PanelLayout& placed) const;

  const Figure* figure_ = nullptr;
  const PageLayout* page_ = nullptr;
};

}  // namespace vibrissa::report
