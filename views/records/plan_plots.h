#pragma once

#include "diagnosis/planning/experiment_plan.h"
#include "report/figures/figure.h"
#include "report/figures/table.h"

namespace vibrissa::views {

/// Expected log likelihood ratio of each effect at its typical strength, strongest first, for an
/// exact simulation and with building tolerances; in brackets an effect that it may be mistaken
/// for. Proven by tests/apps/plan_test.cc.
report::Figure plan_figure(const diagnosis::ExperimentPlan& plan);

/// One row per effect: number, name, size parameter, typical value, detection limits on both kinds
/// of sensor, effects that it may be mistaken for.
report::Table limits_table(const diagnosis::ExperimentPlan& plan);

}  // namespace vibrissa::views
