#pragma once

#include <string>
#include <vector>

#include "diagnosis/localisation/record_gap.h"

namespace vibrissa::diagnosis {

enum class Harmonics { none, odd, even, both };
std::string to_string(Harmonics harmonics);

/// Distortion at the lines that the multisines of base records do not excite, by the parity of
/// their multiple of the base frequency.
Harmonics harmonics_of(const std::vector<RecordGap>& gaps, const RestNoise& rest);

}  // namespace vibrissa::diagnosis
