#pragma once

#include <vector>

#include "diagnosis/record_gap.h"

namespace vibrissa::diagnosis {

/// Does gain or phase of the measured moment against the predicted one have a trend in any record?
bool varies_in_time(const std::vector<RecordGap>& gaps);

}  // namespace vibrissa::diagnosis
