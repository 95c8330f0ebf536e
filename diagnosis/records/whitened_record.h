#pragma once

#include <vector>

#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// A record under a fit: whitened bins.
struct WhitenedRecord {
  std::vector<Complex> error;     // (measured - mean) / sqrt(variance)
  std::vector<double> deviation;  // sqrt(variance) [N m]
  std::vector<double> own_share;  // of the variance, of the effects' own noise
};

/// Share of the variance of a block of bins from which on effects' own noise is a part of it.
inline constexpr double least_own_share = 0.1;

}  // namespace vibrissa::diagnosis
