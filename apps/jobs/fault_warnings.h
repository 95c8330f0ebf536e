#pragma once

#include <string>

#include "signals/files/dataset.h"
#include "signals/record/record.h"

namespace vibrissa::apps {

/// Warns on standard error of what makes a model of the record or its separated moment wrong
/// (checks::recording_faults), but for magnitudes, of which the reader has warned. Proven by
/// tests/apps/check_test.cc.
void warn_of_faults(const std::string& file, const signals::Record& record,
                    const signals::Excitation& excitation = {.base = true});

}  // namespace vibrissa::apps
