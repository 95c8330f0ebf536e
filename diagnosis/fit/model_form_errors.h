#pragma once

#include "diagnosis/fit/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// Upper limit of what the model form errors of linear effects explain [nats], because their forms
/// are well known.
inline constexpr double most_hidden_by_form = 40.;

/// Part of the log likelihood gain of a fit over one with fewer effects that the model form errors
/// of the latter's effects and calibration parameters may explain. A model form error is a smooth
/// function of frequency, one value per block of bins, common to all records:
///   sum over blocks of max(0, E - ln(1 + F)),  E = sum min(g, f) / S,  F = sum f / S,
/// g: power of the difference of the predictions, f: power of the model form errors, around each
/// bin; S: variance. The logarithm is the cost of a free complex value. Model form errors of linear
/// effects do not resemble a nonlinear effect and hide at most 40 nats. Proven by
/// tests/diagnosis/fit/model_form_errors_test.cc.
double hidden_gain(const Experiment& experiment, const HypothesisFit& fit,
                   const HypothesisFit& fewer);

}  // namespace vibrissa::diagnosis
