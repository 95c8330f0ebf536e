#pragma once

#include <array>
#include <set>
#include <vector>

#include "fem/solid_space.h"
#include "flow/drag_law.h"
#include "flow/wind_profile.h"
#include "meshes/sensor_geometry.h"

namespace vibrissa::fem {

/// What the wind meets: which bodies, how wide, over what height.
struct WindExposure {
  std::array<double, 3> axial_direction{1., 0., 0.};
  bool wire = true, fin = true;  // the silicone is always sheltered by the support
  double wire_width = 0.;        // m, for the Reynolds number
  double fin_width = 0.;         // m, mean width of the blades
  double height = 0.;            // m, where the profile is 1
  flow::WindProfile profile = flow::WindProfile::uniform;
  flow::Air air;
};

/// Wind as prescribed pressure on the windward faces of the undeformed sensor. Per reference area,
/// on the reference normal n: traction -p n with p = 0.5 rho Cd(Re) u |u| where n points against
/// the wind (n . e u < 0), so that the resultant along the wind is the drag on the frontal area.
class WindSurface {
 public:
  WindSurface(const SolidSpace& space, const WindExposure& exposure);

  /// Nodal forces in a wind of reference speed u along the axial direction [N].
  void add_force(double speed_m_s, Vector& force) const;

  /// Work of the pressure on each shape over a list of speeds, divided by u|u|:
  /// result[speed][shape]. Shapes need not be zero at the clamp (rigid motions give resultants).
  std::vector<std::vector<double>> coefficients(const std::vector<double>& speeds_m_s,
                                                const std::vector<const Vector*>& shapes) const;

 private:
  struct Point {
    flow::DragBody body;
    double width, height_factor, windward;                     // windward: sign of n . e
    std::array<dealii::types::global_dof_index, 27> unknowns;  // [3 node + component] of the face
    std::array<double, 27> weight;                             // -N n JxW
  };
  void collect(const std::set<dealii::types::boundary_id>& boundaries);
  double pressure(const Point& point, double speed_m_s) const;

  const SolidSpace& space_;
  WindExposure exposure_;
  std::vector<Point> points_;
};

}  // namespace vibrissa::fem
