#pragma once

#include <vector>

#include "diagnosis/diagnosis.h"
#include "report/figures/figure.h"
#include "report/figures/table.h"

namespace vibrissa::views {

/// Gap map, ranking, response and held-out trace before and after correction; plots without data
/// are left out. Proven by tests/apps/diagnose_test.cc.
std::vector<report::Figure> diagnosis_plots(const diagnosis::Diagnosis& diagnosis);

/// The whole held-out record, and below it its first second, which diagnosis_plots() shows alone.
report::Figure held_out_record_figure(const diagnosis::Diagnosis& diagnosis);

/// Peaks of each response: measured, simulated, with the correction.
report::Table level_table(const std::vector<diagnosis::LevelComparison>& levels);

/// One row per answer: probability, prediction errors on held-out records before and after
/// correction, share of the gap closed.
report::Table ranking_table(const diagnosis::Diagnosis& diagnosis);

}  // namespace vibrissa::views
