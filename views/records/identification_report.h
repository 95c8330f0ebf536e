#pragma once

#include <string>

#include "report/figures/table.h"
#include "separation/ringdown/ring_down.h"
#include "separation/verdict/identification_json.h"

namespace vibrissa::views {

report::Table identification_table(const separation::FittedBvrm& fit);

/// The sentence of the verdict, the table of the determined modes, a line for each resonance of
/// which only the frequency is told and for each pair of poles that is not determined.
std::string verdict_text(const separation::FittedBvrm& fit, const separation::Verdict& verdict,
                         const std::string& gain_unit = separation::moment_gain_unit);

/// One row per mode, and one row without damping for each undamped line.
report::Table output_only_table(const separation::OutputOnlyIdentification& found);

/// One row for each point: those of the fitted law, and those that were measured without a law.
report::Table ring_down_table(const separation::RingDown& found);

/// The residual test of the model, as text; of a usable model also poles and zeros.
std::string evidence_text(const separation::ModelEvidence& evidence);

}  // namespace vibrissa::views
