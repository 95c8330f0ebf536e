#pragma once

#include <vector>

#include "diagnosis/finding.h"
#include "signals/dataset.h"

namespace vibrissa::diagnosis {

/// Does the acceleration repeat after period_samples? Its tones must lie on multiples of the
/// period's line. Proven by tests/diagnosis/period_check_test.cc.
void check_period(const signals::DatasetRecord& entry, std::vector<Finding>& findings);

}  // namespace vibrissa::diagnosis
