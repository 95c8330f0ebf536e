#pragma once

#include "case/case_file.h"

namespace vibrissa::apps {

/// Says on standard error how each recorded input of a case was read, and what is wrong with it.
void report_recorded_inputs(const sensor_case::Case& parameters);

}  // namespace vibrissa::apps
