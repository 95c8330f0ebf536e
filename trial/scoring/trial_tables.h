#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "report/figures/figure.h"
#include "report/figures/table.h"
#include "trial/scoring/trial_score.h"

namespace vibrissa::trial {

nlohmann::json to_json(const TrialScore& score);
report::Table case_table(const TrialScore& score);
report::Table summary_table(const TrialScore& score);
/// Every score of the summary for all cases and for each class of circumstances.
report::Table class_table(const TrialScore& score);
/// Wrong answers by true cause and verdict: their number, and the number expected from the stated
/// probabilities.
report::Table confusion_table(const TrialScore& score);
/// Accuracy against effect size, and reliability diagram.
std::vector<report::Figure> trial_figures(const TrialScore& score);

}  // namespace vibrissa::trial
