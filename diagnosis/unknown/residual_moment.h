#pragma once

#include <vector>

#include "diagnosis/model/chain.h"
#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// Mean residual moment of the joint in the bins of a quantity, with its standard deviation.
struct ResidualCurve {
  std::vector<double> x, mean, deviation;
};

/// The moment that the joint would need in addition so that the chain predicts the measured moment:
/// the residual divided by the chain's response to a moment of the joint, at the lines where the
/// response is at least a tenth of its largest value. With J, p and K of JointModel that response
/// is J p / (K (1 + (1 - p) J) + p J): base moments at rest do not show a static moment.
struct ResidualMoment {
  ResidualCurve over_angle{}, over_rate{};  // all in shares of the scales
};
ResidualMoment residual_moment(const Experiment& experiment, const Chain& chain);

}  // namespace vibrissa::diagnosis
