#pragma once

#include <string>

#include "report/figures/table.h"
#include "separation/identification/identification_json.h"

namespace vibrissa::views {

report::Table identification_table(const separation::FittedBvrm& fit);

/// One row per mode, and one row without damping for each undamped line.
report::Table output_only_table(const separation::OutputOnlyIdentification& found);

/// Poles, zeros and the residual test of the model, as text.
std::string evidence_text(const separation::ModelEvidence& evidence);

}  // namespace vibrissa::views
