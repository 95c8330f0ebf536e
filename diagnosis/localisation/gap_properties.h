#pragma once

#include <optional>
#include <string>
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

enum class Harmonics { none, odd, even, both };
std::string to_string(Harmonics harmonics);

/// Distortion at the lines that the multisines of base records do not excite, by the parity of
/// their multiple of the base frequency.
Harmonics harmonics_of(const std::vector<RecordGap>& gaps, const RestNoise& rest);

/// Does the gain or phase of the measured moment relative to the predicted one have a trend in any
/// record?
bool varies_in_time(const std::vector<RecordGap>& gaps);

/// Size of the nominal model's error along one record.
struct GapInTime {
  std::string record{};
  std::vector<double> time_s{};  // middles of equal parts, relative to the start of the record
  std::vector<double> excess{};  // whitened mean square of the error; 1 means noise alone
};

/// The error along every record with an excitation.
std::vector<GapInTime> gap_in_time(const std::vector<RecordGap>& gaps);

}  // namespace vibrissa::diagnosis
