#pragma once

#include <vector>

#include "diagnosis/diagnosis.h"
#include "report/figures/figure.h"
#include "report/figures/table.h"

namespace vibrissa::views {

/// Gap map, ranking, response and held-out trace before and after; what the data do not give is
/// left out. Proven by tests/apps/diagnose_test.cc.
std::vector<report::Figure> diagnosis_plots(const diagnosis::Diagnosis& diagnosis);

/// The trace among diagnosis_plots() below the whole record that it is the first second of.
report::Figure held_out_record_figure(const diagnosis::Diagnosis& diagnosis);

/// One row an answer: probability, held-out errors before and after, share of the gap closed.
report::Table ranking_table(const diagnosis::Diagnosis& diagnosis);

}  // namespace vibrissa::views
