#pragma once

#include <string>
#include <vector>

#include "signals/record/record.h"

namespace vibrissa::signals {

/// Magnitudes that no whisker or airflow sensor on a bench has, and what the unit then probably is:
/// a mean acceleration of 1 (gravity in g), an acceleration beyond 2000 m/s2, a wind faster than
/// 120 m/s, a moment beyond 10 N m, more than 600 s below 2 Hz (time in ms). One line each; empty
/// when all is well. Proven by tests/signals/record/plausibility_test.cc.
std::vector<std::string> implausible_magnitudes(const Record& record);

}  // namespace vibrissa::signals
