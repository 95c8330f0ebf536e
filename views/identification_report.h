#pragma once

#include <string>

#include "report/figures/table.h"
#include "separation/identification/identification_json.h"

namespace vibrissa::views {

report::Table identification_table(const separation::FittedBvrm& fit);

/// One row a mode, and one without damping for each frequency that does not decay.
report::Table output_only_table(const separation::OutputOnlyIdentification& found);

/// What else the records say of the model, in words.
std::string evidence_text(const separation::ModelEvidence& evidence);

}  // namespace vibrissa::views
