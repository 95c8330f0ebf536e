#pragma once

#include "diagnosis/diagnosis.h"
#include "diagnosis/resonances/resonance_gap.h"
#include "report/page/page.h"

namespace vibrissa::views {

/// Verdict, where, what, how far, what next. Proven by tests/apps/diagnosis_page_test.cc.
report::Page diagnosis_page(const diagnosis::Diagnosis& diagnosis);

/// What could explain a gap between two resonances, without records.
report::Page resonance_gap_page(const diagnosis::ResonanceDiagnosis& diagnosis);

}  // namespace vibrissa::views
