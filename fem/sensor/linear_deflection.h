#pragma once

#include <array>

#include "fem/sensor/sensor.h"

namespace vibrissa::fem {

/// Displacement [m] at every node of the linear solid whose base is held at a steady acceleration
/// a_b [m/s^2], in the frame of the base: K u = -M a_b, u = 0 at the clamp. Collective.
/// Proven by tests/fem/sensor/linear_deflection_test.cc.
Vector linear_deflection(const Sensor& sensor, const std::array<double, 3>& base_acceleration_m_s2);

}  // namespace vibrissa::fem
