#pragma once

#include <string>
#include <vector>

#include "diagnosis/localisation/record_gap.h"

namespace vibrissa::diagnosis {

/// Does gain or phase of the measured moment against the predicted one have a trend in any record?
bool varies_in_time(const std::vector<RecordGap>& gaps);

/// How large the error of the nominal model is along one record.
struct GapInTime {
  std::string record{};
  std::vector<double> time_s{};  // middles of equal parts, from the start of the record
  std::vector<double> excess{};  // whitened mean square of the error; 1 is noise alone
};

/// Of every record in which something moves.
std::vector<GapInTime> gap_in_time(const std::vector<RecordGap>& gaps);

}  // namespace vibrissa::diagnosis
