#pragma once

#include <cstddef>
#include <span>

#include "separation/model/fitted_bvrm.h"
#include "separation/model/input_hold.h"
#include "separation/model/rational_model.h"
#include "separation/model/simulation.h"
#include "separation/segments/aligned_segment.h"
#include "signals/spectra/frequency_response.h"

namespace vibrissa::separation {

struct SrivcOptions {
  Hold hold = Hold::first_order;
  bool direct_term = true;
  /// Estimated for each segment together with the model; otherwise at rest at the first sample, no
  /// offset.
  Nuisance nuisance = {};
  int max_iterations = 50;
};

/// Simplified refined instrumental variables for continuous time (Young & Jakeman 1980; Young,
/// Garnier & Gilson 2008, in Identification of Continuous-time Models from Sampled Data), for G = B
/// / A of any even order with a direct term. With the present denominator A0 as prefilter, the
/// linear regression
///   (A / A0) M = (B / A0) a + free responses of A0 + offset + e
/// is solved with the noise-free sensitivities of the present model as instruments, and A0 replaced
/// by A, until the simulated moment changes by less than a thousandth of its deviation due to
/// noise. The regression uses partial fractions over the poles of A0, which are equivalent to
/// powers of s and well conditioned. The input, and the part of the moment that the present model
/// explains, are filtered exactly for the hold; the rest of the moment is filtered with a
/// first-order hold, which has no effect after convergence, when A / A0 = 1. Unstable poles are
/// reflected. Covariance: residual variance times the inverse of the instruments' inner products.
/// end is step_limit when it has not converged, unstable when a pole is above the frequency where
/// aliases begin. Throws UserError as refine_output_error does. Proven by srivc_test.cc,
/// time_domain_fit_test.cc and cramer_rao_test.cc in tests/separation.
FittedBvrm refine_srivc(const Bvrm& start, std::span<const Segment> segments,
                        double sampling_rate_hz, const SrivcOptions& options = {});

/// The same from the fit of a measured frequency response; order is the number of poles, even.
FittedBvrm refine_srivc(const signals::FrequencyResponse& start, std::size_t order,
                        std::span<const Segment> segments, double sampling_rate_hz,
                        const SrivcOptions& options = {});

}  // namespace vibrissa::separation
