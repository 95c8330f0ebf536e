#include "fem/sensor/wind_state_load.h"

namespace vibrissa::fem {

void WindStateLoad::set(const WindInstant& before, const WindInstant& after,
                        const double fraction) {
  before_ = before;
  after_ = after;
  fraction_ = fraction;
}

std::vector<double> WindStateLoad::pressures(const WindInstant& instant,
                                             const std::vector<double>& axial_velocity) const {
  if (!options_.relative_velocity) return surface_.pressures(instant.speed_m_s);
  std::vector<double> velocity(axial_velocity);
  for (double& v : velocity) v += instant.base_velocity_m_s;
  return surface_.pressures(instant.speed_m_s, velocity);
}

std::vector<double> WindStateLoad::pressures(const Vector& v) const {
  std::vector<double> axial_velocity;
  if (options_.relative_velocity) axial_velocity = surface_.axial_velocity(v);
  if (fraction_ == 1.) return pressures(after_, axial_velocity);
  auto result = pressures(before_, axial_velocity);
  if (fraction_ == 0.) return result;
  const auto later = pressures(after_, axial_velocity);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = (1. - fraction_) * result[i] + fraction_ * later[i];
  }
  return result;
}

void WindStateLoad::add_force(const Vector& u, const Vector& v, Vector& force) const {
  if (options_.on_deformed_faces) {
    surface_.faces().add_force(pressures(v), u, force);
  } else {
    surface_.faces().add_force(pressures(v), force);
  }
}

void WindStateLoad::add_tangent(const double factor, const Vector& u, const Vector& v,
                                TangentMatrix& tangent) const {
  if (options_.on_deformed_faces) surface_.faces().add_tangent(factor, pressures(v), u, tangent);
}

}  // namespace vibrissa::fem
