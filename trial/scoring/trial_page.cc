#include "trial/scoring/trial_page.h"

#include <algorithm>

#include "diagnosis/model/words.h"

namespace vibrissa::trial {
namespace {

using diagnosis::percent;

std::string with_interval(const Share& share) {
  const auto [low, high] = share.ci95();
  return std::to_string(share.hits) + " of " + std::to_string(share.of) + ", 95 % interval " +
         percent(low) + " to " + percent(high);
}

report::KeyNumber key_number(const std::string& name, const Share& share) {
  return {name, percent(share.value()), with_interval(share)};
}

std::string headline(const TrialScore& score) {
  const auto right = static_cast<std::size_t>(
      std::count_if(score.cases.begin(), score.cases.end(),
                    [](const ScoredCase& scored) { return scored.right; }));
  return std::to_string(right) + " of " + std::to_string(score.cases.size()) +
         " sealed sensors were diagnosed rightly";
}

}  // namespace

report::Page trial_page(const TrialScore& score, const std::string& commitment) {
  report::Page page{.title = "Blind trial", .headline = headline(score)};
  page.verdict = {"The labels are those that were bound to " + commitment +
                  " before the diagnoses."};
  if (score.unanswered > 0)
    page.verdict.push_back(std::to_string(score.unanswered) + " cases have no answer yet.");
  for (const char* name : {"single at 3 limits, right", "95 % set holds the truth",
                           "wrong name above 0.8", "none, false alarm"})
    if (const auto share = score.shares.find(name); share != score.shares.end())
      page.numbers.push_back(key_number(name, share->second));
  page.sections = {
      {.heading = "Scores",
       .text = {"Shares with exact binomial 95 % intervals; medians and errors without."},
       .tables = {{"summary", "Scores", summary_table(score)}}},
      {.heading = "Accuracy and calibration", .figures = trial_figures(score)},
      {.heading = "Wrong answers",
       .tables = {{"confusion", "Truth against verdict", confusion_table(score)}}},
      {.heading = "Cases", .tables = {{"cases", "Each case", case_table(score), true}}}};
  return page;
}

}  // namespace vibrissa::trial
