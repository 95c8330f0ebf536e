#include "report/drawing/band_painter.h"

#include <vtkContext2D.h>
#include <vtkObjectFactory.h>

#include <cassert>
#include <cmath>

#include "report/drawing/context_painting.h"

namespace vibrissa::report {
namespace {

/// Corners low, high, low, high, ... of a piece of a band without gaps.
void paint_strip(vtkContext2D& painter, std::vector<float>& corners) {
  constexpr std::size_t two_points = 8;
  if (corners.size() >= two_points)
    painter.DrawQuadStrip(corners.data(), static_cast<int>(corners.size() / 2));
  corners.clear();
}

}  // namespace

vtkStandardNewMacro(BandPainter);

bool BandPainter::Paint(vtkContext2D* painter) {
  assert(painter);
  std::vector<float> corners;
  for (const auto& [band, colour] : bands_) {
    set_fill(*painter, colour);
    for (std::size_t i = 0; i < band.x.size(); ++i) {
      if (!std::isfinite(band.x[i] + band.low[i] + band.high[i])) {
        paint_strip(*painter, corners);
        continue;
      }
      for (const double y : {band.low[i], band.high[i]}) {
        corners.push_back(static_cast<float>(band.x[i]));
        corners.push_back(static_cast<float>(y));
      }
    }
    paint_strip(*painter, corners);
  }
  return true;
}

}  // namespace vibrissa::report
