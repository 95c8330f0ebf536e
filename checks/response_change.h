#pragma once

#include <optional>

#include "signals/record/record.h"

namespace vibrissa::checks {

struct ResponseChange {
  double share = 0.;    // rms of the change over rms of the response, without what noise adds
  double p_value = 1.;  // by analysis of variance
};

/// Whether the response from base acceleration to base moment differs between stretches of a
/// record, at the lines that all of them excite alike. A drive that repeats (period_samples > 0):
/// two or three stretches of at least two whole periods, without the first period. Else the thirds
/// of the record, each with four parts that have a Welch response of their own, so that leakage
/// counts as scatter like noise. One-way analysis of variance for each line; its deviates are
/// combined over the lines (Stouffer), and the largest is tested with Holm's correction. Nothing
/// when the chance is above a thousandth, when the change is below what needs no cause in a
/// diagnosis (diagnosis/records/experiment.h), without three such lines, and with fewer periods.
/// Proven by tests/checks/response_change_test.cc.
std::optional<ResponseChange> response_change(const signals::Record& record,
                                              std::size_t period_samples = 0);

}  // namespace vibrissa::checks
