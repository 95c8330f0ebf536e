#pragma once

#include "diagnosis/planning/experiment_plan.h"
#include "report/figures/figure.h"
#include "report/figures/table.h"

namespace vibrissa::views {

/// Evidence for each effect at its typical strength, strongest first, on a sensor that is as
/// simulated otherwise and on one as built; in brackets what it could be taken for. Proven by
/// tests/apps/plan_test.cc.
report::Figure plan_figure(const diagnosis::ExperimentPlan& plan);

/// One row an effect: number, name, size parameter, typical value, limits on both kinds of sensor,
/// what it could be taken for.
report::Table limits_table(const diagnosis::ExperimentPlan& plan);

}  // namespace vibrissa::views
