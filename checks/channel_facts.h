#pragma once

#include <span>

#include "checks/record_report.h"

namespace vibrissa::checks {

/// Range, offset, drift, step and hum of one channel.
/// Drift: least-squares line through the means of 16 parts, told from noise by Student's t at a
/// thousandth. Step: the smallest distance of two values, when 99 % of the distances are multiples
/// of it. Hum: a line at 50 or 60 Hz, or at a multiple up to the tenth, above its neighbours;
/// exponential distribution of the power of noise lines, one false line in a hundred channels.
/// Proven by tests/checks/channel_facts_test.cc.
ChannelFacts channel_facts(const signals::Record& record, const std::string& name);

/// Findings about a channel of this rate: values that are not finite, drift, few steps, hum; a time
/// or a counter that is no channel, and the samples that a counter tells lost.
void find_channel_faults(const ChannelFacts& facts, double sampling_rate_hz,
                         std::vector<Finding>& findings);

}  // namespace vibrissa::checks
