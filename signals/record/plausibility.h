#pragma once

#include <string>
#include <vector>

#include "signals/record/record.h"

namespace vibrissa::signals {

/// Remarks on magnitudes that no whisker or airflow sensor on a bench has, with the probable unit:
/// a mean acceleration of 1 (gravity in g), an acceleration above 2000 m/s2, a wind speed above 120
/// m/s, a moment above 10 N m, more than 600 s at less than 2 Hz (time in ms). One text for each;
/// empty when all magnitudes are plausible. Proven by tests/signals/record/plausibility_test.cc.
std::vector<std::string> implausible_magnitudes(const Record& record);

}  // namespace vibrissa::signals
