#pragma once

#include <span>

#include "diagnosis/fit/predicted_noise.h"
#include "diagnosis/records/whitened_record.h"

namespace vibrissa::diagnosis {

/// How well a fit's variance describes its residual.
struct GoodnessOfFit {
  /// Mean of the whitened residual's power less one: what neither the effects nor the bounds of
  /// their form errors explain.
  double excess = 0.;
  /// Log likelihood that a larger variance would gain in blocks of bins, of records that are moved
  /// alike, in which the effects' own noise is a tenth or more of the variance:
  ///   sum over blocks with m > 1 of max(0, n (m - 1 - ln m) - ln(n) / 2),  m mean power of n bins;
  /// noise of the right power with the wrong spectrum has much of it. Some 10 nats by chance.
  double misshape_nats = 0.;
  /// The same over all blocks, a bin.
  double surplus_nats_per_bin = 0.;
  /// Largest |error|^2 of a line of the records at rest, but the lowest, less ln(their lines): what
  /// the loudest tone that the fit lacks stands out of chance.
  double tone_nats = 0.;
  PredictedNoise predicted;
};

/// records: residual of the experiment's records under a fit. Proven by
/// tests/diagnosis/fit/goodness_of_fit_test.cc.
GoodnessOfFit goodness_of_fit(const Experiment& experiment,
                              std::span<const WhitenedRecord> records);

}  // namespace vibrissa::diagnosis
