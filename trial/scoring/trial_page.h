#pragma once

#include <string>

#include "report/page/page.h"
#include "trial/scoring/trial_score.h"

namespace vibrissa::trial {

/// Report page with the scores of a trial; commitment: hash of the labels. Proven by
/// tests/apps/trial_test.cc.
report::Page trial_page(const TrialScore& score, const std::string& commitment);

}  // namespace vibrissa::trial
