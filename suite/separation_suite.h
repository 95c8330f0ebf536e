#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "report/figures/figure.h"
#include "report/figures/table.h"
#include "suite/separation_scenarios.h"
#include "views/records/separation_scores.h"

namespace vibrissa::suite {

/// Results of all methods in one scenario.
struct ScenarioResult {
  std::string name, about;
  double sampling_rate_hz = 0., duration_s = 0.;
  std::vector<views::SeparatedSignal> methods;
};

/// Runs every method on a scenario with its default settings. The BVRM is identified on the record
/// without stimulus, or on the record itself when there is none. The first two seconds are left out
/// of the scores.
ScenarioResult separate_by_all(const Scenario& scenario);
std::size_t n_suite_methods();

/// One row per scenario and method.
report::Table suite_table(const std::vector<ScenarioResult>& results);
/// SDR in dB: one row per scenario, one column per method.
report::Table sdr_table(const std::vector<ScenarioResult>& results);
report::Figure suite_figure(const std::vector<ScenarioResult>& results);
nlohmann::json suite_json(const std::vector<ScenarioResult>& results);

}  // namespace vibrissa::suite
