#pragma once

#include "diagnosis/fit/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// Variance of a channel's noise, a sample [(N m)^2, (m/s^2)^2], and the deviation of the logarithm
/// of its root.
struct NoiseLevel {
  double variance = 0., log_deviation = 0.;
};

struct NoiseLevels {
  NoiseLevel moment, acceleration;
};

/// As measured where nothing moves, so that the error of a poor fit is no noise; else as fitted. A
/// fit that names noise of the accelerometer knows its share. chain: the fit's. Proven by
/// tests/diagnosis/validation/held_out_test.cc and carry_over_test.cc.
NoiseLevels noise_levels(const Experiment& experiment, const HypothesisFit& fit,
                         const Chain& chain);

}  // namespace vibrissa::diagnosis
