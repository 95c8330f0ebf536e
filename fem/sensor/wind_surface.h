#pragma once

#include <array>
#include <span>
#include <vector>

#include "fem/solid/loaded_faces.h"
#include "fem/solid/solid_space.h"
#include "flow/drag_law.h"
#include "flow/wind_profile.h"
#include "meshes/sensor_geometry.h"

namespace vibrissa::fem {

/// Parts of the sensor that the wind loads, with their width and height.
struct WindExposure {
  std::array<double, 3> axial_direction{1., 0., 0.};
  bool wire = true, fin = true;  // the wind never loads the silicone
  double wire_width = 0.;        // m, for the Reynolds number
  double fin_width = 0.;         // m, mean width of the blades
  double height = 0.;            // m, where the profile is 1
  flow::WindProfile profile = flow::WindProfile::uniform;
  flow::Air air;
};

/// Wind as pressure p = 0.5 rho Cd(Re) w|w| on the windward faces (T6.1), w the air speed relative
/// to the point along the axial direction. Windward faces and heights are those of the undeformed
/// sensor. On the reference area the resultant along the wind is the drag on the frontal area.
/// Proven by tests/fem/sensor/wind_surface_test.cc.
class WindSurface {
 public:
  WindSurface(const SolidSpace& space, const WindExposure& exposure);

  const LoadedFaces& faces() const { return faces_; }
  /// Pressure at the points of the faces [Pa] for a wind with the reference speed u along the axial
  /// direction; axial_velocity_m_s: velocities of the points [m/s], empty when they are at rest.
  std::vector<double> pressures(double speed_m_s,
                                std::span<const double> axial_velocity_m_s = {}) const;
  /// Axial velocities of the points, relative to the base.
  std::vector<double> axial_velocity(const Vector& velocity) const;

  /// Nodal forces on the sensor at rest and undeformed [N].
  void add_force(double speed_m_s, Vector& force) const;

  /// Work of the pressure on each shape over a list of speeds, divided by u|u|:
  /// result[speed][shape]. Shapes need not be zero at the clamp (rigid motions give resultants).
  std::vector<std::vector<double>> coefficients(const std::vector<double>& speeds_m_s,
                                                const std::vector<const Vector*>& shapes) const;

 private:
  struct Point {
    flow::DragBody body;
    double width, height_factor;
    double windward;  // sign of n . e, zero when the face is parallel to the wind
  };
  double pressure(const Point& point, double relative_speed_m_s) const;
  /// Work of a unit pressure at each point on a shape [m^3].
  std::vector<double> work(const Vector& shape) const;

  WindExposure exposure_;
  dealii::Tensor<1, 3> axis_;
  LoadedFaces faces_;
  std::vector<Point> points_;
};

}  // namespace vibrissa::fem
