#include "fem/sensor/wind_surface.h"

#include <cassert>
#include <cmath>
#include <set>

#include "meshes/regions.h"

namespace vibrissa::fem {

namespace {

std::set<dealii::types::boundary_id> boundaries(const WindExposure& exposure) {
  std::set<dealii::types::boundary_id> ids;
  if (exposure.wire) ids.insert(meshes::boundary::wire_surface);
  if (exposure.fin) ids.insert(meshes::boundary::fin_surface);
  return ids;
}

}  // namespace

WindSurface::WindSurface(const SolidSpace& space, const WindExposure& exposure)
    : exposure_(exposure),
      axis_(
          {exposure.axial_direction[0], exposure.axial_direction[1], exposure.axial_direction[2]}),
      faces_(space, boundaries(exposure)) {
  // Faces along the wind have normals that are zero but for rounding.
  constexpr double grazing = 1e-9;
  for (const auto& face : faces_.faces()) {
    const bool on_wire = face.boundary == meshes::boundary::wire_surface;
    for (const auto& at : face.points) {
      const double along = at.normal * axis_;
      Point& point = points_.emplace_back();
      point.body = on_wire ? flow::DragBody::wire : flow::DragBody::blades;
      point.width = on_wire ? exposure.wire_width : exposure.fin_width;
      point.height_factor = flow::profile_factor(exposure.profile, at.position[2], exposure.height);
      point.windward = std::abs(along) < grazing ? 0. : along < 0. ? -1. : 1.;
    }
  }
}

// Positive on the windward side only; acts along -n, that is with the wind.
double WindSurface::pressure(const Point& point, const double relative_speed_m_s) const {
  if (point.windward * relative_speed_m_s >= 0.) return 0.;
  return std::abs(flow::drag_pressure(point.body, point.width, relative_speed_m_s, exposure_.air));
}

std::vector<double> WindSurface::pressures(const double speed_m_s,
                                           const std::span<const double> axial_velocity_m_s) const {
  assert(axial_velocity_m_s.empty() || axial_velocity_m_s.size() == points_.size());
  std::vector<double> result;
  result.reserve(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double velocity = axial_velocity_m_s.empty() ? 0. : axial_velocity_m_s[i];
    result.push_back(pressure(points_[i], points_[i].height_factor * speed_m_s - velocity));
  }
  return result;
}

std::vector<double> WindSurface::axial_velocity(const Vector& velocity) const {
  return faces_.component(velocity, axis_);
}

void WindSurface::add_force(const double speed_m_s, Vector& force) const {
  faces_.add_force(pressures(speed_m_s), force);
}

std::vector<double> WindSurface::work(const Vector& shape) const {
  std::vector<double> result(points_.size(), 0.);
  for (unsigned int d = 0; d < 3; ++d) {
    dealii::Tensor<1, 3> direction;
    direction[d] = 1.;
    const auto along = faces_.component(shape, direction);
    std::size_t i = 0;
    for (const auto& face : faces_.faces()) {
      for (const auto& at : face.points) {
        // Other processes count their own faces.
        if (face.owned) result[i] -= at.area * at.normal[d] * along[i];
        ++i;
      }
    }
  }
  return result;
}

std::vector<std::vector<double>> WindSurface::coefficients(
    const std::vector<double>& speeds_m_s, const std::vector<const Vector*>& shapes) const {
  std::vector<std::vector<double>> motion;
  for (const Vector* shape : shapes) motion.push_back(work(*shape));
  std::vector<std::vector<double>> result;
  for (const double speed : speeds_m_s) {
    assert(speed != 0. && "the coefficient is a limit there");
    const auto at_points = pressures(speed);
    std::vector<double> row(shapes.size(), 0.);
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const double weight = at_points[p] / (speed * std::abs(speed));
      for (std::size_t k = 0; k < shapes.size(); ++k) row[k] += weight * motion[k][p];
    }
    for (double& value : row) {
      value = dealii::Utilities::MPI::sum(value, faces_.space().dofs().get_communicator());
    }
    result.push_back(row);
  }
  return result;
}

}  // namespace vibrissa::fem
