#pragma once

#include <vector>

#include "diagnosis/fit/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// What the residual of a fit says of one effect more, to first order.
struct Resemblance {
  /// Twice the log likelihood that the best multiple of the effect's own shape gains.
  double gain = 0.;
  /// Of the effect's parameters, at the size that suits the residual; empty: no size does.
  std::vector<double> values{};
};

/// The most alike of the given values. residual: of fit. Shapes are those of a change of the mean
/// or of the noise. Proven by tests/diagnosis/search/resemblance_test.cc.
Resemblance resemblance(const Experiment& experiment, const HypothesisFit& fit,
                        const std::vector<WhitenedRecord>& residual, const Effect& effect,
                        const std::vector<std::vector<double>>& tried);

}  // namespace vibrissa::diagnosis
