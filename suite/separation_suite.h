#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "report/figures/figure.h"
#include "report/figures/table.h"
#include "suite/separation_scenarios.h"
#include "views/separation_scores.h"

namespace vibrissa::suite {

/// What the methods of one scenario reached.
struct ScenarioResult {
  std::string name, about;
  double sampling_rate_hz = 0., duration_s = 0.;
  std::vector<views::SeparatedSignal> methods;
};

/// Runs every method on a scenario, each with its default settings; the BVRM is identified on the
/// record without stimulus, or where there is none on the record itself. The first two seconds are
/// left out of the scores.
ScenarioResult separate_by_all(const Scenario& scenario);
std::size_t n_suite_methods();

/// One row a scenario and method.
report::Table suite_table(const std::vector<ScenarioResult>& results);
/// One row a scenario, one column a method: SDR in dB.
report::Table sdr_table(const std::vector<ScenarioResult>& results);
report::Figure suite_figure(const std::vector<ScenarioResult>& results);
nlohmann::json suite_json(const std::vector<ScenarioResult>& results);

}  // namespace vibrissa::suite
