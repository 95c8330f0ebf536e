#pragma once

#include <span>
#include <vector>

namespace vibrissa::signals {

/// Base motion below this frequency is ignored: the integral of the offset and drift of an
/// accelerometer would grow without bound.
inline constexpr double slowest_base_motion_hz = 0.5;

/// Velocity of a base from a record of its acceleration [m/s^2 -> m/s]: A(f) / (2 pi j f) at the
/// lines of the record above slowest_base_motion_hz, hence with zero mean. Exact for records of
/// whole periods; other records are treated as periodic. A record that is shorter than one period
/// of its motion gives a poor result. Proven by tests/signals/model/base_velocity_test.cc.
std::vector<double> base_velocity(std::span<const double> acceleration_m_s2,
                                  double sampling_rate_hz);

}  // namespace vibrissa::signals
