#pragma once

#include <string>
#include <vector>

#include "diagnosis/localisation/record_gap.h"

namespace vibrissa::diagnosis {

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
