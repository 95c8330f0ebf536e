#pragma once

#include <span>
#include <string>

#include "separation/identification/output_error.h"
#include "separation/model/fitted_bvrm.h"
#include "separation/segments/aligned_segment.h"

namespace vibrissa::separation {

struct ScatteredFit {
  FittedBvrm fit;     // the same model, its deviations widened where the pieces disagree
  std::string words;  // which modes differ between the pieces; empty: none
};

/// Widens the deviations of a fit by what its pieces tell: the thirds of one or two segments, or
/// three and more segments themselves. Each piece gives its own estimate by one Gauss-Newton step
/// from the model, with its own initial state and offset. Where the estimates of an unknown scatter
/// by chi^2 beyond the 99 % limit of n - 1 degrees of freedom, its deviation is multiplied by
/// sqrt(chi^2 / (n - 1)) (Birge 1932; Particle Data Group, Review of Particle Physics, section
/// 5.2.2): then the sensor, or the noise, was not the same in all pieces. Pieces that do not
/// determine the unknowns are left out. Proven by
/// tests/separation/identification/piece_scatter_test.cc.
ScatteredFit widen_by_scatter(const FittedBvrm& fit, std::span<const Segment> segments,
                              double sampling_rate_hz, const OutputErrorOptions& options);

}  // namespace vibrissa::separation
