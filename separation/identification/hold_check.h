#pragma once

#include <span>
#include <string>
#include <vector>

#include "separation/identification/srivc.h"

namespace vibrissa::separation {

/// The same records fitted under one hold.
struct HoldTrial {
  Hold hold = Hold::first_order;
  FittedBvrm fit;
  double residual_rms_n_m = 0.;
  /// By how much the strongest mode's moment leads (positive) or lags what a mode can, with its
  /// standard deviation: b1 / b0 lies between 0 (an elastic moment) and 2 zeta / w (elastic and
  /// viscous, see signals/model/reduced_model.h).
  Estimate unphysical_lead_s;
};

struct HoldDiagnosis {
  Hold told = Hold::first_order;
  Hold likely = Hold::first_order;  // the one told, unless something speaks against it
  std::string words;                // empty: nothing does
  std::vector<HoldTrial> trials;    // the one told first
};

/// Asks whether the base acceleration ran between its samples as told, by fitting the records under
/// every hold from the given model. Two kinds of evidence:
/// - Another hold leaves a residual smaller by more than four standard deviations (of the mean
///   difference of squared residuals over 40 pieces of the records, so that coloured noise does not
///   count for more than it is).
/// - With a direct term, zero_order and first_order are the same family of difference equations:
///   the residuals are equal, and the wrong one turns up as half a sample of delay in the modes,
///   which no mode can have. A missing delay looks the same, and the words say so. At rates where
///   2 zeta / w is half a sample the two cannot be told apart, and nothing is said.
/// Proven by tests/separation/identification/hold_check_test.cc.
HoldDiagnosis check_hold(const Bvrm& model, std::span<const Segment> segments,
                         double sampling_rate_hz, const SrivcOptions& told);

}  // namespace vibrissa::separation
