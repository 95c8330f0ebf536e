#pragma once

#include <span>

#include "diagnosis/records/whitened_record.h"

namespace vibrissa::diagnosis {

/// Part of the residual that a fit attributes to process noise but the measured wind predicts.
struct PredictedNoise {
  double nats = 0.;   // gain of the regression beyond the chance gain of its coefficients
  double share = 0.;  // of the residual's energy, in blocks with process noise
};

/// In each block of bins (frequency_block.h, joined where they hold few) of each record with wind
/// in which process noise is a tenth or more of the variance, and which has no process noise
/// without wind, the whitened residual is regressed on the spectra of the wind's speed and of its
/// square: e = X theta + n. Noise follows neither, and |X theta|^2 has mean p, the rank of X
/// (independence test; Ljung, System Identification, 1999, 16.6). Proven by
/// tests/diagnosis/fit/predicted_noise_test.cc.
PredictedNoise predicted_noise(const Experiment& experiment,
                               std::span<const WhitenedRecord> records);

}  // namespace vibrissa::diagnosis
