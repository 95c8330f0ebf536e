#include "fem/sensor/prestressed_modes.h"

#include "fem/factors/sparse_factors.h"
#include "fem/solid/internal_force.h"
#include "fem/solid/static_solution.h"
#include "fem/solid/tangent_matrix.h"
#include "signals/base/error.h"

namespace vibrissa::fem {

namespace {

[[noreturn]] void refuse_buckled(const std::string& why) {
  throw signals::UserError(
      "the sensor does not carry its weight under Transient/Gravity: it buckles, or the load is "
      "too "
      "high for this mesh; check the direction and size of gravity and the stiffness (" +
      why + ")");
}

Vector sagged(const std::array<double, 3>& gravity_m_s2, const SolidSpace& space,
              const SolidOperators& operators) {
  StaticLoad weight;
  weight.body_acceleration_m_s2 = gravity_m_s2;
  try {
    return solve_static(space, operators, weight).displacement;
  } catch (const NoEquilibrium& error) {
    refuse_buckled(error.what());
  }
}

}  // namespace

std::vector<Mode> solve_modes_under(const std::array<double, 3>& gravity_m_s2,
                                    const SolidSpace& space, const SolidOperators& operators,
                                    const unsigned int n_modes,
                                    const std::array<double, 3>& axial_direction) {
  if (gravity_m_s2 == std::array<double, 3>{})
    return solve_modes(space, operators, n_modes, axial_direction);
  const Vector u = sagged(gravity_m_s2, space, operators);
  TangentMatrix tangent(space, *operators.mass, space.clamped());
  tangent.start(0.);
  operators.internal_force->add_tangent(1., u, u, tangent);
  tangent.finish();
  const auto product = [&](const Vector& x, Vector& force) {
    tangent.matrix().vmult(force, x);
    zero_entries(force, space.clamped());
  };
  try {
    return solve_modes(space, operators, {tangent.matrix(), product}, n_modes, axial_direction);
  } catch (const IndefiniteMatrix& error) {
    refuse_buckled(error.what());
  }
}

}  // namespace vibrissa::fem
