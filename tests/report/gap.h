#pragma once

#include <limits>

namespace vibrissa::report {

/// The value at which a curve is interrupted.
constexpr double gap = std::numeric_limits<double>::quiet_NaN();

}  // namespace vibrissa::report
