#pragma once

#include <span>

#include "report/figures/figure.h"
#include "separation/ringdown/ring_down.h"

namespace vibrissa::views {

/// The moment [N m] with the envelope of the fitted law; frequency and damping against amplitude by
/// the law and without one, with 95 % intervals. Proven by tests/apps/identify_command_test.cc.
report::Figure ring_down_figure(const separation::RingDown& found, std::span<const double> moment,
                                double sampling_rate_hz);

}  // namespace vibrissa::views
