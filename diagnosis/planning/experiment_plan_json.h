#pragma once

#include <string>

#include "diagnosis/planning/experiment_plan.h"

namespace vibrissa::diagnosis {

/// Schema "vibrissa-plan-1": assumed records and noise, effects with their detection limits and
/// indistinguishable alternatives, experiments of the menu. Numbers that are not finite become
/// null. Proven by tests/diagnosis/planning/experiment_plan_json_test.cc.
std::string plan_json(const ExperimentPlan& plan);

/// The plan as at most 20 lines of at most 100 characters for a terminal.
std::string plan_text(const ExperimentPlan& plan);

}  // namespace vibrissa::diagnosis
