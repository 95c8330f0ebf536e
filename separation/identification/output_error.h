#pragma once

#include <span>
#include <vector>

#include "separation/model/fitted_bvrm.h"
#include "separation/model/input_hold.h"
#include "separation/model/rational_model.h"
#include "separation/model/simulation.h"
#include "separation/segments/aligned_segment.h"

namespace vibrissa::separation {

struct OutputErrorOptions {
  Hold hold = Hold::first_order;
  bool direct_term = true;
  /// Without it b1 = 0 in every mode: the moment is elastic (see ModalTerm).
  bool viscous_term = true;
  /// Estimated for each segment together with the model; otherwise at rest at the first sample, no
  /// offset.
  Nuisance nuisance = {};
  int max_iterations = 100;
};

/// Output-error fit in the time domain (maximum likelihood for white noise on the moment):
///   M[n] = (G a)[n] + free response of each mode + offset + e[n],  with minimum sum e^2 over (b1,
///   b0, a1, a0) of every mode and D, from the given initial model, whose gains are first fitted
///   linearly. The delay is that of the initial model. Sensitivities are exact derivatives of the
///   difference
/// equation, by filtering. Covariance: residual variance times (J^T J)^-1. Several segments are
/// fitted together; the noise is assumed equal in all of them. Throws UserError for an initial
/// model that is unstable or above half the sampling rate, segments of unequal lengths, values that
/// are not finite, or fewer samples than unknowns. Proven by output_error_test.cc (gradient,
/// Cramer-Rao bound) and time_domain_fit_test.cc in tests/separation.
FittedBvrm refine_output_error(const Bvrm& start, std::span<const Segment> segments,
                               double sampling_rate_hz, const OutputErrorOptions& options = {});

/// Measured minus simulated moment (simulate_like()), one segment after the other.
std::vector<double> output_errors(const Bvrm& model, std::span<const Segment> segments,
                                  double sampling_rate_hz, const OutputErrorOptions& options);

}  // namespace vibrissa::separation
