#pragma once

#include <string>

#include "apps/trial_score.h"
#include "report/page.h"

namespace vibrissa::apps {

/// How often diagnoses were right; commitment: what the labels were bound to. Proven by
/// tests/apps/trial_test.cc.
report::Page trial_page(const TrialScore& score, const std::string& commitment);

}  // namespace vibrissa::apps
