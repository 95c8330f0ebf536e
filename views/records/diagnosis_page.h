#pragma once

#include "diagnosis/diagnosis.h"
#include "diagnosis/resonances/resonance_gap.h"
#include "report/page/page.h"

namespace vibrissa::views {

/// Report page with verdict, location of the gap, cause, improvement, next experiment. Proven by
/// tests/apps/diagnosis_page_test.cc.
report::Page diagnosis_page(const diagnosis::Diagnosis& diagnosis);

/// Report page with possible causes of the difference between two resonances, without records.
report::Page resonance_gap_page(const diagnosis::ResonanceDiagnosis& diagnosis);

}  // namespace vibrissa::views
