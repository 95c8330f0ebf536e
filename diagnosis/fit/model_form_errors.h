#pragma once

#include "diagnosis/fit/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// Of a linear effect's form little is unknown: its error explains no more than this, in nats.
inline constexpr double most_hidden_by_form = 40.;

/// Of the log likelihood that a fit gains over one with fewer effects, the part that form errors
/// of the latter's effects and calibrations may explain. A form error is a smooth function of
/// frequency, one value to a block of bins, shared by the records:
///   sum over blocks of max(0, E - ln(1 + F)),  E = sum min(g, f) / S,  F = sum f / S,
/// g the power by which the predictions differ, f that of the form errors, around each bin, S the
/// variance; the logarithm is the price of a free complex value. Form errors of linear effects do
/// not look like a nonlinear effect, and hide no more than 40 nats.
/// Proven by tests/diagnosis/fit/model_form_errors_test.cc.
double hidden_gain(const Experiment& experiment, const HypothesisFit& fit,
                   const HypothesisFit& fewer);

}  // namespace vibrissa::diagnosis
