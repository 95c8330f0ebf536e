#pragma once

#include <string>

#include "diagnosis/planning/experiment_plan.h"

namespace vibrissa::diagnosis {

/// Schema "vibrissa-plan-1": records and noise supposed, effects with their limits and what is
/// alike, the steps of the menu. Numbers that are not finite become null. Proven by
/// tests/diagnosis/planning/experiment_plan_json_test.cc.
std::string plan_json(const ExperimentPlan& plan);

/// At most 20 lines of at most 100 characters for a terminal.
std::string plan_text(const ExperimentPlan& plan);

}  // namespace vibrissa::diagnosis
