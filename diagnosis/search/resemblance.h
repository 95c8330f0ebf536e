#pragma once

#include <memory>
#include <vector>

#include "diagnosis/fit/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// First-order estimate of a further effect from the residual of a fit.
struct Resemblance {
  /// Gain in twice the log likelihood by the best multiple of the effect's shape.
  double gain = 0.;
  /// Values of the effect's parameters at the best size; empty when there is none within the
  /// ranges.
  std::vector<double> values{};
};

/// The residual of a fit, against which further effects are held. The fit's parameters and the
/// discrepancy are free to follow an effect's shape: only what neither explains counts.
class FitResidual {
 public:
  FitResidual(const Experiment& experiment, const HypothesisFit& fit);
  ~FitResidual();

  /// The given values whose shape matches the residual best. A shape is a change of the mean or of
  /// the noise. Proven by tests/diagnosis/search/resemblance_test.cc.
  Resemblance resemblance(const Effect& effect,
                          const std::vector<std::vector<double>>& tried) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vibrissa::diagnosis
