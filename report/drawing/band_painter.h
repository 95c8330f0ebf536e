#pragma once

#include <vtkContextItem.h>

#include <utility>
#include <vector>

#include "report/figures/envelope.h"
#include "report/figures/palette.h"

namespace vibrissa::report {

/// Paints bands given in pixels. It replaces vtkPlotArea, which omits a band of two points.
class BandPainter : public vtkContextItem {
 public:
  static BandPainter* New();
  vtkTypeMacro(BandPainter, vtkContextItem);
  BandPainter(const BandPainter&) = delete;
  void operator=(const BandPainter&) = delete;

  void add(Band band, const Colour& colour) { bands_.emplace_back(std::move(band), colour); }
  bool Paint(vtkContext2D* painter) override;

 protected:
  BandPainter() = default;
  ~BandPainter() override = default;

 private:
  std::vector<std::pair<Band, Colour>> bands_;
};

}  // namespace vibrissa::report
