#pragma once

#include "diagnosis/fit/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// Noise variance of a channel per sample [(N m)^2, (m/s^2)^2], and the standard deviation of the
/// logarithm of its square root.
struct NoiseLevel {
  double variance = 0., log_deviation = 0.;
};

struct NoiseLevels {
  NoiseLevel moment, acceleration;
};

/// Noise levels measured at rest, so that the error of a poor fit does not count as noise; without
/// such records as fitted. A fit that names reference_noise includes it. chain: the fit's chain.
/// Proven by tests/diagnosis/validation/held_out_test.cc.
NoiseLevels noise_levels(const Experiment& experiment, const HypothesisFit& fit,
                         const Chain& chain);

}  // namespace vibrissa::diagnosis
