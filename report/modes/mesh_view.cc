#include "report/modes/mesh_view.h"

#include <vtkPoints.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vibrissa::report {
namespace {

constexpr double turned = 20. * std::numbers::pi / 180., raised = 18. * std::numbers::pi / 180.;

Eigen::Vector3d point(vtkPolyData& shape, const vtkIdType i) {
  double x[3];
  shape.GetPoint(i, x);
  return {x[0], x[1], x[2]};
}

/// Angle of the axis in the x-y plane along which the points move most; 0 when no direction
/// dominates.
double direction_of_motion(const DeformedMesh& mesh) {
  double xx = 0., xy = 0., yy = 0.;
  for (vtkIdType i = 0; i < mesh.rest->GetNumberOfPoints(); ++i) {
    const Eigen::Vector3d move = point(*mesh.deformed, i) - point(*mesh.rest, i);
    xx += move.x() * move.x();
    xy += move.x() * move.y();
    yy += move.y() * move.y();
  }
  const double anisotropy = std::hypot(xx - yy, 2. * xy);
  return anisotropy > 0.05 * (xx + yy) ? 0.5 * std::atan2(2. * xy, xx - yy) : 0.;
}

}  // namespace

MeshView view_of(const DeformedMesh& mesh) {
  const double angle = direction_of_motion(mesh) - turned;
  MeshView view;
  view.right = {std::cos(angle), std::sin(angle), 0.};
  view.toward = std::cos(raised) * Eigen::Vector3d(std::sin(angle), -std::cos(angle), 0.) +
                std::sin(raised) * Eigen::Vector3d::UnitZ();
  view.up = view.toward.cross(view.right);

  Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array3d high = -low;
  for (vtkPolyData* shape : {mesh.rest.Get(), mesh.deformed.Get()})
    for (vtkIdType i = 0; i < shape->GetNumberOfPoints(); ++i) {
      const Eigen::Vector3d x = point(*shape, i);
      const Eigen::Array3d seen(x.dot(view.right), x.dot(view.up), x.dot(view.toward));
      low = low.min(seen);
      high = high.max(seen);
    }
  const Eigen::Array3d middle = 0.5 * (low + high);
  view.centre = middle[0] * view.right + middle[1] * view.up + middle[2] * view.toward;
  view.width = high[0] - low[0];
  view.height = high[1] - low[1];
  return view;
}

}  // namespace vibrissa::report
