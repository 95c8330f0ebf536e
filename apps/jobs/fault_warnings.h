#pragma once

#include <string>

#include "case/case_file.h"
#include "signals/record/record.h"

namespace vibrissa::apps {

/// Warns on standard error of what makes a model of the record or its separated moment wrong
/// (checks::recording_faults), but for magnitudes, of which the reader has warned. Proven by
/// tests/apps/check_test.cc.
void warn_of_faults(const std::string& file, const signals::Record& record);

/// Says on standard error how each recorded input of a case was read, and what is wrong with it.
void report_recorded_inputs(const sensor_case::Case& parameters);

}  // namespace vibrissa::apps
