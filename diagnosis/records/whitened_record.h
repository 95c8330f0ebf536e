#pragma once

#include <vector>

#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// Whitened bins of a record under a fit.
struct WhitenedRecord {
  std::vector<Complex> error;     // (measured - mean) / sqrt(variance)
  std::vector<double> deviation;  // sqrt(variance) [N m]
  std::vector<double> own_share;  // share of process noise in the variance
};

/// Share of the variance of a frequency block from which on its process noise counts.
inline constexpr double least_own_share = 0.1;

}  // namespace vibrissa::diagnosis
