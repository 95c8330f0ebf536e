#include "fem/sensor/linear_deflection.h"

#include "fem/factors/cholesky_solver.h"

namespace vibrissa::fem {

Vector linear_deflection(const Sensor& sensor,
                         const std::array<double, 3>& base_acceleration_m_s2) {
  const SolidSpace& space = sensor.space();
  Vector base = space.make_vector(), force = space.make_vector(), found = space.make_vector();
  for (unsigned int d = 0; d < 3; ++d) base.add(-base_acceleration_m_s2[d], space.translation(d));
  sensor.operators().mass->vmult(force, base);
  zero_entries(force, space.clamped());
  const CholeskySolver solver(*sensor.operators().clamped_stiffness,
                              [&](const Vector& x, Vector& product) {
                                clamped_internal_force(space, sensor.operators(), x, product);
                              });
  solver.solve(force, found);
  return found;
}

}  // namespace vibrissa::fem
