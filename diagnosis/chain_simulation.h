#pragma once

#include <vector>

#include "diagnosis/chain.h"
#include "diagnosis/experiment.h"

namespace vibrissa::diagnosis {

/// What a chain foretells of one prepared record, bins as PreparedRecord::moment.
struct Prediction {
  std::vector<Complex> mean;
  /// Of white noise of unit standard deviation a sample at both channels, and of the effects' own.
  std::vector<double> moment_noise;        // times the moment's variance
  std::vector<double> acceleration_noise;  // times the accelerometer's variance
  std::vector<double> own_noise;           // as it is
  double ramp_variance = 0.;  // of the rise of a line through the judged part [(N m)^2]
};

/// Linear parts exactly for band-limited inputs, by transfer functions at the lines of the record
/// (its start, where the circular continuation is wrong, is not judged); what the joint and the
/// relative wind add is integrated in time on a finer grid with a second-order exponential rule.
Prediction simulate(const Chain& chain, const PreparedRecord& record);

/// Means alone.
std::vector<Complex> simulate_mean(const Chain& chain, const PreparedRecord& record);

}  // namespace vibrissa::diagnosis
