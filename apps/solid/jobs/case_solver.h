#pragma once

#include <string>

#include "signals/model/reduced_model.h"

namespace vibrissa::apps {

/// The reduced model of a case file, a CaseSolver. Throws UserError like sensor_case::CaseFile.
signals::ReducedModel solve_case(const std::string& file, bool show_progress);

}  // namespace vibrissa::apps
