#pragma once

#include <span>

#include "diagnosis/fit/predicted_noise.h"
#include "diagnosis/records/whitened_record.h"

namespace vibrissa::diagnosis {

/// Agreement between a fit's variance and its residual.
struct GoodnessOfFit {
  /// Mean power of the whitened residual minus one: the part that neither the effects nor the
  /// bounds of their model form errors explain.
  double excess = 0.;
  /// Gain in log likelihood by a larger variance in blocks of bins, over records with the same
  /// excitation, in which the process noise is a tenth or more of the variance:
  ///   sum over blocks with m > 1 of max(0, n (m - 1 - ln m) - ln(n) / 2),  m mean power of n bins;
  /// It is large for process noise of the right power with the wrong spectrum. About 10 nats occur
  /// by chance.
  double misshape_nats = 0.;
  /// The same over all blocks, per bin.
  double surplus_nats_per_bin = 0.;
  /// Largest |error|^2 of a line of the records at rest (without the lowest lines) minus ln(number
  /// of lines): significance of the strongest tone that the fit does not explain [nats].
  double tone_nats = 0.;
  PredictedNoise predicted;
};

/// records: residual of the experiment's records under a fit. Proven by
/// tests/diagnosis/fit/goodness_of_fit_test.cc.
GoodnessOfFit goodness_of_fit(const Experiment& experiment,
                              std::span<const WhitenedRecord> records);

}  // namespace vibrissa::diagnosis
