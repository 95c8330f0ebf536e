#pragma once

#include <array>
#include <vector>

#include "fem/sensor/modes.h"

namespace vibrissa::fem {

/// Modes of small vibration about the equilibrium u under gravity: K(u) phi = w^2 M phi, where the
/// tangent K(u) = d2W/du2 (T13.2) contains the stresses of u (geometric stiffness), so that a
/// standing whisker has lower frequencies and a hanging one higher ones. Gravity keeps its
/// direction, so it adds no stiffness of its own. Participations refer to the undeformed positions.
/// Zero gravity: solve_modes at rest. Throws UserError when the sensor buckles under its weight.
/// Proven by tests/fem/sensor/prestressed_modes_test.cc (heavy cantilever).
std::vector<Mode> solve_modes_under(const std::array<double, 3>& gravity_m_s2,
                                    const SolidSpace& space, const SolidOperators& operators,
                                    unsigned int n_modes,
                                    const std::array<double, 3>& axial_direction = {1., 0., 0.});

}  // namespace vibrissa::fem
