#pragma once

#include <span>
#include <vector>

#include "separation/identification/output_error.h"
#include "separation/model/fitted_bvrm.h"
#include "separation/segments/aligned_segment.h"

namespace vibrissa::separation {

/// Which unknowns a model has beside gain and pole of each mode, and how the input runs.
struct ModelStructure {
  Hold hold = Hold::first_order;
  bool direct_term = true;
  bool viscous_term = true;
};

/// Chooses the hold among `holds`, and whether the records determine the direct term and the
/// viscous terms b1. Unknowns that are not needed make the estimates of the others worse: an
/// unknown phase of the residue doubles the variance of the frequency. Each hold is fitted once
/// with all unknowns, from the given model, to segments whose error is white (see Whitener); the
/// cost of leaving unknowns out follows from the Wald statistic v^T C^-1 v of their values v. The
/// smallest n ln(mean e^2) + unknowns ln n is taken (Schwarz 1978; Ljung, System Identification,
/// 2nd ed., section 16.4). Structures within 2 of it cannot be told apart (Kass & Raftery 1995):
/// the one whose strongest mode answers least before its input is taken, see unphysical_lead().
/// With a direct term and viscous terms, zero_order and first_order are one family; without, they
/// are told apart. `fit` says which unknowns are allowed at all. Proven by
/// tests/separation/identification/structure_choice_test.cc.
ModelStructure choose_structure(const FittedBvrm& found, std::span<const Segment> segments,
                                double sampling_rate_hz, const std::vector<Hold>& holds,
                                const OutputErrorOptions& fit);

}  // namespace vibrissa::separation
