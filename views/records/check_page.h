#pragma once

#include <span>

#include "checks/check_file.h"
#include "report/figures/figure.h"
#include "report/figures/table.h"
#include "report/page/page.h"

namespace vibrissa::views {

/// One row for each source and command: good, limited or no, and the reasons.
report::Table serves_table(std::span<const checks::CheckResult> results);

/// Samples and spectra of all channels, and the coherence of moment and acceleration with the limit
/// that unrelated noise keeps; one figure for each of the first records.
std::vector<report::Figure> check_plots(std::span<const checks::CheckResult> results);

/// Report page with the table of commands, and for each record its channels, findings and figure.
/// Proven by tests/apps/check_test.cc.
report::Page check_page(std::span<const checks::CheckResult> results);

}  // namespace vibrissa::views
