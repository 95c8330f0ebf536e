#pragma once

#include "tests/signals/peak.h"

namespace vibrissa::fem {

/// Of the records that the transient tests drive a sensor with.
constexpr double rate_hz = 1000.;

using signals::test::peak;

}  // namespace vibrissa::fem
