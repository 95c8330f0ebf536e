#pragma once

namespace vibrissa::flow {

/// Wind speed over height, relative to its reference: uniform (1) or parabolic, 2 s - s^2 with
/// s = z/height (0 at the support, 1 at the tip).
enum class WindProfile { uniform, parabolic };

/// The factor at height z; s is limited to [0, 1], because rounding or deflection can move a point
/// outside. Proven by tests/flow/wind_profile_test.cc.
double profile_factor(WindProfile profile, double z, double height);

}  // namespace vibrissa::flow
