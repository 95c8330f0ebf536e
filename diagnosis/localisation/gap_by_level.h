#pragma once

#include <optional>
#include <vector>

#include "diagnosis/localisation/record_gap.h"

namespace vibrissa::diagnosis {

/// The relative gap grows as level^value.
struct LevelExponent {
  double value = 0.;  // 0 where it does not differ from 0
  double deviation = 0.;
};

/// From the excited lines of periodic base records, noise taken off; nothing when there is one
/// level only or no gap under base motion.
std::optional<LevelExponent> level_exponent(const std::vector<RecordGap>& gaps);

}  // namespace vibrissa::diagnosis
