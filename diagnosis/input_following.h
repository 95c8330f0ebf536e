#pragma once

#include "diagnosis/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// Standard deviations by which a fit's residual follows what moves the sensor more than noise and
/// the bounds of form errors allow: whatever answers the inputs and is in no effect of the fit. In
/// each block of driven bins (frequency_block.h, joined where they hold few) of each moved record
/// the residual is regressed on the foretold moment, the base's acceleration and the wind's speed,
///   e = X theta + n,   T = theta^H (C + Phi)^-1 theta,
/// C the covariance of theta by the residual's own noise, Phi what a form error of the allowed
/// power would be if all of it lay on one regressor; T has mean and variance p, the number of
/// regressors, by chance, less where the bounds are wide. Returned: sum (T - p) / sqrt(sum p). The
/// independence test of system identification (Ljung, System Identification, 16.6) by frequency.
/// Proven by tests/diagnosis/input_following_test.cc.
double input_following(const Experiment& experiment, const HypothesisFit& fit);

}  // namespace vibrissa::diagnosis
