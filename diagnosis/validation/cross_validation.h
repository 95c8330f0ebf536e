#pragma once

#include <string>

#include "diagnosis/search/search.h"

namespace vibrissa::diagnosis {

/// Residual of a fit in the held-out record that contradicts it most; when none contradicts it, in
/// the record with the largest residual.
struct ResidualExcess {
  std::string record{};
  /// Power of the residual divided by the power that the fit allows, minus one:
  ///   sum |M - mean|^2 / sum S - 1,
  /// S: noise of both channels, 1.5 times the process noise, and the bounds of the model form
  /// errors.
  double excess = 0.;
  /// The same in standard deviations, sum (|M - mean|^2 - S) / sqrt(sum S^2).
  double n_deviations = 0.;
  /// Excess power divided by that of the nominal model.
  double share_of_gap = 1.;
};

/// fitted_on: experiment of the fit; held_out: records prepared with Split::held_out and
/// InputNoise::as_measured. Noise levels are those measured at rest, also when the fit is poor.
/// Only the rise of a drift is fitted. Proven by
/// tests/diagnosis/validation/cross_validation_test.cc.
ResidualExcess residual_excess(const Experiment& fitted_on, const Experiment& held_out,
                               const HypothesisFit& fit);

/// Does the record contradict the fit? A correct answer also predicts other levels and winds. An
/// answer that closes nearly all of a gap is not contradicted by small remaining causes.
bool contradicted_by(const ResidualExcess& left);

/// Cross-validates the most probable answers in turn, up to the first that the held-out records
/// confirm; the ones before it are rejected. When no answer of nearly the same probability is
/// confirmed, all known answers are rejected.
void refute_contradicted(SearchResult& result, const Experiment& fitted_on,
                         const Experiment& held_out);

}  // namespace vibrissa::diagnosis
