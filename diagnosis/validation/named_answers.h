#pragma once

#include "diagnosis/search/search.h"

namespace vibrissa::diagnosis {

/// Reduces each answer to what closes the gap, and gives it the names of its changes. An effect
/// that closes less than least_share of what recalibration alone leaves, or less than any
/// simulation's error, in fitted and unseen records together, is left out of the name where a fit
/// without it is known: the simpler answer wins. The values are those of the fuller fit where it
/// predicts unseen records better. Calibration parameters are named by named_calibrations(). Where
/// least_share or more of the gap is left, and more than any discrepancy, the cause is outside the
/// catalogue. Answers of the same name become one. fitted, scored: the fit records and those to be
/// scored, prepared with InputNoise::as_measured. Proven by
/// tests/diagnosis/validation/named_answers_test.cc.
void name_answers(SearchResult& result, const Experiment& experiment, const Experiment& fitted,
                  const Experiment& scored);

}  // namespace vibrissa::diagnosis
