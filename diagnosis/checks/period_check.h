#pragma once

#include <vector>

#include "diagnosis/checks/finding.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Checks that the acceleration repeats after period_samples: its tones must lie on multiples of
/// the period's frequency. Proven by tests/diagnosis/checks/period_check_test.cc.
void check_period(const signals::DatasetRecord& entry, std::vector<Finding>& findings);

}  // namespace vibrissa::diagnosis
