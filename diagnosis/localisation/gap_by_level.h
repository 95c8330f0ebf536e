#pragma once

#include <optional>
#include <vector>

#include "diagnosis/localisation/record_gap.h"

namespace vibrissa::diagnosis {

/// Exponent of the relative gap, which grows as level^value.
struct LevelExponent {
  double value = 0.;  // 0 where it does not differ significantly from 0
  double deviation = 0.;
};

/// Exponent from the excited lines of periodic base records, minus noise; nothing when there is one
/// level only or no gap under base motion.
std::optional<LevelExponent> level_exponent(const std::vector<RecordGap>& gaps);

}  // namespace vibrissa::diagnosis
