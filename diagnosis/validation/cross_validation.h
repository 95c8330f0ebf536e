#pragma once

#include <string>

#include "diagnosis/search/search.h"

namespace vibrissa::diagnosis {

/// What a fit leaves of the record that contradicted_by it most, among those it has not seen; of
/// the one it follows worst, where none does.
struct ResidualExcess {
  std::string record{};
  /// Power of the residual over all that the fit allows for, less one:
  ///   sum |M - mean|^2 / sum S - 1,
  /// S noise of both channels, 1.5 times the effects' own noise and the bounds of their form
  /// errors.
  double excess = 0.;
  /// The same in deviations of chance, sum (|M - mean|^2 - S) / sqrt(sum S^2).
  double n_deviations = 0.;
  /// Over what the nominal model leaves of the same, beyond what is allowed.
  double share_of_gap = 1.;
};

/// fitted_on: the experiment of the fit; held_out: records prepared with Split::held_out and
/// InputNoise::as_measured. Noise that was measured at rest is not taken for louder because the fit
/// is poor. Nothing is fitted but the rise of a drift. Proven by
/// tests/diagnosis/validation/cross_validation_test.cc.
ResidualExcess residual_excess(const Experiment& fitted_on, const Experiment& held_out,
                               const HypothesisFit& fit);

/// Does it contradict the fit? A cause, or none, that is right carries over to other levels and
/// winds. One that closes nearly all of a gap is not contradicted by what finer causes leave.
bool contradicted_by(const ResidualExcess& left);

/// The most probable answers are asked in turn, up to the first that held-out records confirm: the
/// others are refuted. Where nothing nearly as probable is confirmed all known answers are.
void refute_contradicted(SearchResult& result, const Experiment& fitted_on,
                         const Experiment& held_out);

}  // namespace vibrissa::diagnosis
