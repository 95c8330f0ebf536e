#pragma once

#include <optional>
#include <span>

#include "signals/record/clock.h"

namespace vibrissa::signals {

/// The even clock behind jittering stamps that do not wrap around. Where more than one sample in
/// twenty would be lost and the steps have two or three lengths, the stamps are those of bursts
/// read from a buffer, and the mean rate is that of the device. Nothing where the sampling is not
/// even: the stamps wander from every grid. Proven by tests/signals/record/clock_test.cc.
std::optional<Clock> regress_stamps(std::span<const double> times_s, double rounding_s);

}  // namespace vibrissa::signals
