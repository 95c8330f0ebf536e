#pragma once

#include <string>

#include "report/table.h"
#include "separation/identification_json.h"

namespace vibrissa::apps {

report::Table identification_table(const separation::FittedBvrm& fit);

/// One row a mode, and one without damping for each frequency that does not decay.
report::Table output_only_table(const separation::OutputOnlyIdentification& found);

/// What else the records say of the model, in words.
std::string evidence_text(const separation::ModelEvidence& evidence);

}  // namespace vibrissa::apps
