#pragma once

#include "checks/record_report.h"

namespace vibrissa::checks {

/// One mode with its direct term has five unknowns, and a line gives two numbers.
inline constexpr std::size_t fewest_coherent_lines = 3;

struct ChannelHum {
  std::vector<HumLine> acceleration{}, moment{};
};

/// The relation between base acceleration and base moment: coherent band
/// (separation/verdict/coherence.h), coherent share (separation/metrics/coherent_power.h), delay
/// and usable model (separation/verdict/verdict.h). Adds the findings: no or poor coherence, few
/// excited lines, exchanged columns, opposite sign, delay, power up to half the sampling rate, a
/// response that changes during the record. hum: lines that tell nothing of the response. Proven by
/// tests/checks/check_record_test.cc.
ResponseFacts response_facts(const signals::Record& record, const DriveFacts& drive,
                             const ChannelHum& hum, std::vector<Finding>& findings);

}  // namespace vibrissa::checks
