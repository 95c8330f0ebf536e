#include "trial/scoring/trial_score.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "diagnosis/model/effect.h"
#include "diagnosis/search/calibrated_odds.h"
#include "signals/base/json_input.h"

namespace vibrissa::trial {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double well_above = 3.;
constexpr double sure = 0.8;

void count(std::map<std::string, Share>& shares, const ScoredCase& c) {
  if (c.has_notes_alone() && c.kind != CaseClass::below_limit) {
    shares["notes alone, nothing else named"].add(c.right);
    return;
  }
  const bool named =
      c.kind == CaseClass::single || c.kind == CaseClass::pair || c.kind == CaseClass::triple;
  const bool in_catalogue =
      named || c.kind == CaseClass::none || c.kind == CaseClass::calibration_only;
  const bool outside = c.kind == CaseClass::nameless || c.kind == CaseClass::left_out;
  if (c.kind == CaseClass::single && c.size_in_limits >= well_above) {
    shares["single at 3 limits, right"].add(c.right);
    shares["single at 3 limits, right within sets"].add(c.right_within_set);
    shares["single at 3 limits, not called none"].add(c.exit_status == 0 && c.verdict != "none");
  }
  if (c.kind == CaseClass::single) shares["single of all sizes, right"].add(c.right);
  if (in_catalogue) shares["in the catalogue, right"].add(c.right);
  if (in_catalogue) shares["top three"].add(c.in_top_three);
  if (c.kind != CaseClass::wrong_metadata) shares["no answer"].add(c.exit_status != 0);
  if (c.kind == CaseClass::pair || c.kind == CaseClass::triple)
    shares[to_string(c.kind) + ", exact"].add(c.right);
  if (c.kind == CaseClass::none || c.kind == CaseClass::calibration_only)
    shares[to_string(c.kind) + ", false alarm"].add(without_calibrations(c.verdict) != "none");
  if (outside) {
    shares[to_string(c.kind) + ", outside_catalogue"].add(c.right);
    shares[to_string(c.kind) + ", wrong name above 0.8"].add(!c.right && c.verdict != "none" &&
                                                             c.probability > sure);
  }
  if (c.kind == CaseClass::below_limit)
    shares["below the limit, wrong name above 0.8"].add(c.verdict != "none" && !c.right &&
                                                        c.probability > sure);
  if (c.kind == CaseClass::wrong_metadata) shares["wrong metadata, noticed"].add(c.right);
  if (in_catalogue) {
    shares["wrong name above 0.8"].add(!c.right && c.verdict != "none" && c.probability > sure);
  }
  if (in_catalogue || outside) shares["95 % set holds the truth"].add(c.in_confidence_set);
  // Calibrations that are off lie in links of their own.
  if (named && !c.is_off_in_calibrations()) shares["links right"].add(c.links_right);
  for (const bool covered : c.calibrations_covered)
    shares["calibrations, true value in the 95 % interval"].add(covered);
  if (in_catalogue && c.resolved_as_recommended)
    shares["undecided, the recommended experiment resolves"].add(*c.resolved_as_recommended);
  if (in_catalogue && c.resolved_by_chance)
    shares["undecided, another one resolves"].add(*c.resolved_by_chance);
}

/// Does the case have an answer whose probability can be calibrated?
bool counts_for_odds(const ScoredCase& c) {
  return c.exit_status == 0 && c.kind != CaseClass::wrong_metadata &&
         c.kind != CaseClass::below_limit;
}

void learn_trust(TrialScore& out) {
  static const std::map<diagnosis::AnswerKind, std::string> names{
      {diagnosis::AnswerKind::none, "none"},
      {diagnosis::AnswerKind::single, "single"},
      {diagnosis::AnswerKind::several, "several"},
      {diagnosis::AnswerKind::outside, "outside"}};
  std::map<std::string, std::vector<std::pair<double, bool>>> answers;
  for (const ScoredCase& c : out.cases) {
    if (!counts_for_odds(c)) continue;
    const std::string& kind = names.at(diagnosis::answer_kind(c.verdict));
    answers[kind].emplace_back(diagnosis::log_odds(c.probability / c.probability_of_tried),
                               c.right);
    if (!c.right) out.unknown[kind].add(c.truth == diagnosis::outside_catalogue);
  }
  for (const auto& [kind, of_kind] : answers)
    out.trust[kind] = {logistic_line(of_kind), of_kind.size()};
}

std::map<std::string, double> figures_of(const std::vector<const ScoredCase*>& cases) {
  std::vector<double> closed, transfer, errors, seconds, known, outside, set_sizes;
  std::vector<std::pair<double, bool>> answers;
  for (const ScoredCase* there : cases) {
    const ScoredCase& c = *there;
    if (c.gap_closed) closed.push_back(*c.gap_closed);
    if (c.transfer_gap_closed) transfer.push_back(*c.transfer_gap_closed);
    errors.insert(errors.end(), c.parameter_errors.begin(), c.parameter_errors.end());
    if (c.exit_status != 0 || c.kind == CaseClass::wrong_metadata) continue;
    seconds.push_back(c.seconds);
    set_sizes.push_back(static_cast<double>(c.confidence_set_size));
    const bool is_outside = c.kind == CaseClass::nameless || c.kind == CaseClass::left_out;
    if (!counts_for_odds(c)) continue;
    if (!c.has_notes_alone()) (is_outside ? outside : known).push_back(c.probability_of_outside);
    answers.emplace_back(c.probability, c.right);
  }
  const std::vector<ReliabilityBin> bins = reliability(answers);
  const double n = static_cast<double>(set_sizes.size());
  return {{"gap closed, median", quantile(closed, 0.5)},
          {"gap closed, 5th percentile", quantile(closed, 0.05)},
          {"gap closed at another level and wind, median", quantile(transfer, 0.5)},
          {"parameter error over its deviation, median", quantile(errors, 0.5)},
          {"seconds a case, median", quantile(seconds, 0.5)},
          {"outside_catalogue, area under the curve", auroc(known, outside)},
          {"expected calibration error", expected_calibration_error(bins)},
          {"95 % set, mean size", std::accumulate(set_sizes.begin(), set_sizes.end(), 0.) / n}};
}

std::vector<ReliabilityBin> reliability_of(const std::vector<ScoredCase>& cases) {
  std::vector<std::pair<double, bool>> answers;
  for (const ScoredCase& c : cases)
    if (counts_for_odds(c)) answers.emplace_back(c.probability, c.right);
  return reliability(answers);
}

Scores scores_of(const std::vector<const ScoredCase*>& cases) {
  Scores out;
  for (const ScoredCase* c : cases) count(out.shares, *c);
  out.figures = figures_of(cases);
  return out;
}

void add_class(TrialScore& out, const std::string& name,
               const std::function<bool(const ScoredCase&)>& holds) {
  std::vector<const ScoredCase*> of_class;
  for (const ScoredCase& c : out.cases)
    if (c.circumstances && holds(c)) of_class.push_back(&c);
  if (!of_class.empty()) out.classes.emplace_back(name, scores_of(of_class));
}

template <class Value>
void split(TrialScore& out, const std::string& what, const std::vector<Value>& values,
           Value Circumstances::*member) {
  for (const Value value : values)
    add_class(out, what + ": " + to_string(value),
              [&](const ScoredCase& c) { return (*c.circumstances).*member == value; });
}

}  // namespace

TrialScore score_trial(const TrialIndex& trial, const json& labels) {
  TrialScore out;
  for (const TrialEntry& entry : trial.cases) {
    const fs::path file = trial.answer_file(entry);
    if (fs::exists(file))
      out.cases.push_back(score_case(entry.name, labels.at(entry.name), signals::read_json(file)));
    else
      ++out.unanswered;
  }
  std::vector<const ScoredCase*> all;
  for (const ScoredCase& c : out.cases) all.push_back(&c);
  Scores total = scores_of(all);
  out.shares = std::move(total.shares);
  out.figures = std::move(total.figures);
  out.reliability = reliability_of(out.cases);
  learn_trust(out);
  split(out, "set", record_sets(), &Circumstances::set);
  split(out, "distance", distances(), &Circumstances::distance);
  split(out, "form error", form_errors(), &Circumstances::form_error);
  for (const char* hold : {"band_limited", "linear", "zero_order"})
    add_class(out, std::string("hold: ") + hold,
              [&](const ScoredCase& c) { return c.hold == hold; });
  split(out, "way in", {WayIn::records, WayIn::model}, &Circumstances::way_in);
  return out;
}

}  // namespace vibrissa::trial
