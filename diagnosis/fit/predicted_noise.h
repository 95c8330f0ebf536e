#pragma once

#include <span>

#include "diagnosis/records/whitened_record.h"

namespace vibrissa::diagnosis {

/// What the measured wind predicts of a residual that a fit calls noise of its effects.
struct PredictedNoise {
  double nats = 0.;   // that the regression gains beyond what its coefficients gain by chance
  double share = 0.;  // of the residual's energy, where effects' own noise is a part of it
};

/// In each block of bins (frequency_block.h, joined where they hold few) of each record with wind
/// in which an effect's own noise is a tenth or more of the variance, and is not in records without
/// wind, the whitened residual is regressed on the spectra of the wind's speed and of its square: e
/// = X theta + n. Noise follows neither, and |X theta|^2 has mean p, the rank of X (independence
/// test; Ljung, System Identification, 1999, 16.6). Proven by
/// tests/diagnosis/fit/predicted_noise_test.cc.
PredictedNoise predicted_noise(const Experiment& experiment,
                               std::span<const WhitenedRecord> records);

}  // namespace vibrissa::diagnosis
