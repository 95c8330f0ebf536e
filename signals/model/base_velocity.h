#pragma once

#include <span>
#include <vector>

namespace vibrissa::signals {

/// Slower motion of a base than this is taken for none: an accelerometer's offset and drift would
/// run away in its integral.
inline constexpr double slowest_base_motion_hz = 0.5;

/// Velocity of a base from a record of its acceleration [m/s^2 -> m/s]: A(f) / (2 pi j f) on the
/// record's lines above slowest_base_motion_hz, so without mean. Exact for records of whole
/// periods; others are taken for periodic, and one shorter than a period of their motion tells
/// little of it. Proven by tests/signals/model/base_velocity_test.cc.
std::vector<double> base_velocity(std::span<const double> acceleration_m_s2,
                                  double sampling_rate_hz);

}  // namespace vibrissa::signals
