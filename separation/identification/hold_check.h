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
  /// Time by which the moment of the strongest mode leads (positive) or lags the possible response
  /// of a mode, with its standard deviation: b1 / b0 is between 0 (elastic moment) and 2 zeta / w
  /// (elastic and viscous, see signals/model/reduced_model.h).
  Estimate unphysical_lead_s;
};

/// Of the mode with the largest peak, see HoldTrial; 0 within the physical range.
Estimate unphysical_lead(const FittedBvrm& fit);

struct HoldDiagnosis {
  Hold told = Hold::first_order;
  Hold likely = Hold::first_order;  // the given hold, unless the data contradict it
  std::string words;                // empty: no contradiction
  std::vector<HoldTrial> trials;    // the given hold first
};

/// Tests the assumed hold of the base acceleration: fits the records under every hold, from the
/// given model. Two kinds of evidence:
/// - Another hold leaves a residual smaller by more than four standard deviations (of the mean
///   difference of squared residuals over 40 pieces of the records, which is also valid for
///   coloured noise).
/// - With a direct term, zero_order and first_order are the same family of difference equations:
///   the residuals are equal, and the wrong hold appears as a delay of half a sample in the modes,
///   which is not possible for a mode. A missing delay has the same effect; the text says so. At
///   sampling rates where 2 zeta / w is half a sample, the two cannot be distinguished, and the
///   text is empty.
/// Proven by tests/separation/identification/hold_check_test.cc.
HoldDiagnosis check_hold(const Bvrm& model, std::span<const Segment> segments,
                         double sampling_rate_hz, const SrivcOptions& told);

}  // namespace vibrissa::separation
