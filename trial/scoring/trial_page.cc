#include "trial/scoring/trial_page.h"

#include <algorithm>

#include "diagnosis/model/words.h"
#include "trial/scoring/trial_tables.h"

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
         " sensors with sealed labels were diagnosed correctly";
}

}  // namespace

report::Page trial_page(const TrialScore& score, const std::string& commitment) {
  report::Page page{.title = "Blind trial", .headline = headline(score)};
  page.verdict = {"The labels match the commitment " + commitment +
                  " (salted SHA-256), which was made before the diagnoses."};
  if (score.unanswered > 0)
    page.verdict.push_back(std::to_string(score.unanswered) + " cases have no diagnosis yet.");
  for (const char* name : {"single at 3 limits, right", "95 % set holds the truth",
                           "wrong name above 0.8", "none, false alarm"})
    if (const auto share = score.shares.find(name); share != score.shares.end())
      page.numbers.push_back(key_number(name, share->second));
  page.sections = {
      {.heading = "Scores",
       .text = {"Shares have exact binomial 95 % intervals; medians and errors have no interval. "
                "Sizes are multiples of the detection limit."},
       .tables = {{"summary", "Scores", summary_table(score)}}},
      {.heading = "Accuracy and calibration", .figures = trial_figures(score)},
      {.heading = "Wrong answers",
       .tables = {{"confusion", "True cause and verdict of the wrong answers",
                   confusion_table(score)}}},
      {.heading = "Cases", .tables = {{"cases", "All cases", case_table(score), true}}}};
  if (!score.classes.empty())
    page.sections.insert(page.sections.begin() + 1,
                         {.heading = "Scores by circumstances",
                          .text = {"What each sensor came with: its set of records, its distance "
                                   "from the simulation, the simulation's form error, the hold of "
                                   "its input, and the way in which it was given."},
                          .tables = {{"classes", "Scores by circumstances", class_table(score)}}});
  return page;
}

}  // namespace vibrissa::trial
