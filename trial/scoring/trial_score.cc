#include "trial/scoring/trial_score.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "diagnosis/model/effect.h"
#include "diagnosis/model/hypothesis.h"
#include "diagnosis/search/calibrated_odds.h"
#include "diagnosis/search/confidence_set.h"
#include "signals/base/exit_status.h"
#include "signals/base/json_input.h"
#include "signals/base/student.h"

namespace vibrissa::trial {
namespace {

namespace fs = std::filesystem;
using diagnosis::effect_ids;
using diagnosis::joined_name;
using nlohmann::json;

std::string truth_of(const CaseClass kind, const json& effects) {
  if (kind == CaseClass::nameless || kind == CaseClass::left_out)
    return diagnosis::outside_catalogue;
  std::vector<std::string> ids;
  for (const json& effect : effects) ids.push_back(effect.at("id"));
  return ids.empty() ? "none" : joined_name(ids);
}

std::string without_calibrations(const std::string& name) {
  std::vector<std::string> ids;
  for (const std::string& id : effect_ids(name)) {
    const auto& calibrations = diagnosis::nuisance_ids();
    if (std::find(calibrations.begin(), calibrations.end(), id) == calibrations.end())
      ids.push_back(id);
  }
  return joined_name(ids);
}

bool is_right(const CaseClass kind, const std::string& truth, const std::string& verdict) {
  return (kind == CaseClass::calibration_only ? without_calibrations(verdict) : verdict) == truth;
}

bool within_a_set(const json& sets, const std::string& truth, const std::string& verdict) {
  return std::any_of(sets.begin(), sets.end(), [&](const json& set) {
    const auto holds = [&](const std::string& id) {
      return std::find(set.begin(), set.end(), id) != set.end();
    };
    return holds(truth) && holds(verdict);
  });
}

bool links_are_right(const std::string& truth, const json& links) {
  std::set<std::string> expected, said;
  for (const std::string& id : effect_ids(truth))
    expected.insert(to_string(diagnosis::find_effect(id).link));
  for (std::size_t i = 0; i < std::min(links.size(), expected.size()); ++i) said.insert(links[i]);
  return said == expected;
}

/// The true value of a diagnosed parameter, where the generator's size is the same quantity.
std::optional<double> true_value(const std::string& id, const std::string& parameter, double size) {
  static const std::map<std::pair<std::string, std::string>, double> offsets{
      {{"delay", "tau"}, 0.},
      {{"flow_lag", "tau"}, 0.},
      {{"clock_drift", "rate_error"}, 0.},
      {{"reference_highpass", "corner"}, 0.},
      {{"damping", "ratio"}, 1.},
      {{"reference_gain", "ratio"}, 1.},
      {{"sensor_gain", "ratio"}, 1.},
      {{"drag_error", "ratio"}, 1.}};
  const auto found = offsets.find({id, parameter});
  if (found == offsets.end()) return std::nullopt;
  return found->second + size;
}

std::vector<double> parameter_errors(const json& answer, const json& effects) {
  constexpr double deviations_in_interval = 2. * signals::normal_quantile_975;
  std::vector<double> out;
  for (const json& effect : effects)
    for (const json& p : answer.at("parameters")) {
      if (p.at("effect") != effect.at("id") || p.at("value").is_null()) continue;
      const auto truth = true_value(effect.at("id"), p.at("name"), effect.at("size"));
      const double width = p.at("ci95")[1].get<double>() - p.at("ci95")[0].get<double>();
      if (!truth || width <= 0.) continue;
      out.push_back(std::abs(p.at("value").get<double>() - *truth) * deviations_in_interval /
                    width);
    }
  return out;
}

std::optional<double> number_of(const json& value) {
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

bool is_transfer(const std::string& record) {
  return record.starts_with("other_");
}

/// Share of the gap closed over the records of one kind, with equal weights; nothing where the gap
/// of these records is not larger than their noise.
std::optional<double> gap_closed(const json& held_out, bool transfer) {
  constexpr double stands_out = 1.2;  // times the floor
  double before = 0., after = 0., floor = 0.;
  for (const json& record : held_out.at("records")) {
    if (is_transfer(record.at("record")) != transfer) continue;
    const auto b = number_of(record.at("nrmse_before")), a = number_of(record.at("nrmse_after")),
               f = number_of(record.at("noise_floor_nrmse"));
    if (!b || !a || !f) continue;
    before += *b * *b - *f * *f;
    after += *a * *a - *f * *f;
    floor += *f * *f;
  }
  if (before <= (stands_out * stands_out - 1.) * floor) return std::nullopt;
  return 1. - after / before;
}

/// Answers of "vibrissa-diagnosis-1" have another name for what is read here.
json as_version_2(json diagnosis) {
  if (diagnosis.value("schema", "") != "vibrissa-diagnosis-1") return diagnosis;
  for (json& answer : diagnosis.at("ranking")) {
    json& held_out = answer.at("held_out");
    if (held_out.is_null()) continue;
    held_out["not_predictable"] = held_out.at("not_foretold");  // version 1
  }
  return diagnosis;
}

void read_answer(ScoredCase& out, const json& diagnosis, const json& effects) {
  out.verdict = diagnosis.at("verdict");
  const json& ranking = diagnosis.at("ranking");
  out.probability = ranking.at(0).at("probability");
  out.probability_of_tried = diagnosis.value("probability_of_tried", 1.);
  out.probability_of_outside = diagnosis.value("probability_of_outside", 0.);
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    const std::string name = ranking[i].at("effect");
    if (i < 3) out.in_top_three |= is_right(out.kind, out.truth, name);
    out.probabilities[name] = ranking[i].at("probability");
  }
  out.right = is_right(out.kind, out.truth, out.verdict);
  out.right_within_set =
      out.right || within_a_set(diagnosis.at("indistinguishable"), out.truth, out.verdict);
  const json& set = diagnosis.at("confidence_set");
  out.confidence_set_size = set.size();
  out.in_confidence_set = std::any_of(set.begin(), set.end(), [&](const json& name) {
    return is_right(out.kind, out.truth, name);
  });
  out.links_right = out.truth == diagnosis::outside_catalogue ||
                    links_are_right(out.truth, diagnosis.at("location").at("links"));
  const json& held_out = ranking[0].at("held_out");
  // No answer closes the gap of a random effect, and outside_catalogue adds nothing to the model.
  if (out.right && out.verdict != diagnosis::outside_catalogue && !held_out.is_null() &&
      held_out.at("not_predictable").empty()) {
    out.gap_closed = gap_closed(held_out, false);
    out.transfer_gap_closed = gap_closed(held_out, true);
  }
  if (out.right) out.parameter_errors = parameter_errors(ranking[0], effects);
}

std::optional<bool> resolved(const ScoredCase& c, const json& answer, const char* which) {
  if (!answer.contains(which)) return std::nullopt;
  const json& after = answer.at(which);
  // An experiment without an answer has resolved nothing.
  if (!after.contains("verdict")) return false;
  return diagnosis::n_known(after.at("confidence_set").get<std::vector<std::string>>()) == 1 &&
         is_right(c.kind, c.truth, after.at("verdict"));
}

ScoredCase scored(const std::string& name, const json& label, const json& answer) {
  ScoredCase out{
      .name = name, .kind = parse_case_class(label.at("class")), .truth = {}, .verdict = {}};
  const json& effects = label.at("effects");
  out.truth = truth_of(out.kind, effects);
  for (const json& effect : effects) {
    out.effects.append(out.effects.empty() ? "" : "+").append(effect.at("id").get<std::string>());
    const double ratio =
        std::abs(effect.at("size").get<double>()) / effect.at("limit").get<double>();
    out.size_in_limits = out.size_in_limits == 0. ? ratio : std::min(out.size_in_limits, ratio);
  }
  out.exit_status = answer.at("exit_status");
  if (out.exit_status != 0) {
    out.verdict = "refused";
    out.right =
        out.kind == CaseClass::wrong_metadata && out.exit_status == signals::exit_status::bad_input;
    return out;
  }
  out.seconds = answer.at("seconds");
  read_answer(out, as_version_2(answer.at("diagnosis")), effects);
  out.resolved_as_recommended = resolved(out, answer, "recommended");
  out.resolved_by_chance = resolved(out, answer, "by_chance");
  if (out.kind == CaseClass::wrong_metadata)
    out.right = !answer.at("diagnosis").at("findings").empty() && out.verdict == "none";
  return out;
}

constexpr double well_above = 3.;
constexpr double sure = 0.8;

void count(TrialScore& out, const ScoredCase& c) {
  const bool named =
      c.kind == CaseClass::single || c.kind == CaseClass::pair || c.kind == CaseClass::triple;
  const bool in_catalogue =
      named || c.kind == CaseClass::none || c.kind == CaseClass::calibration_only;
  const bool outside = c.kind == CaseClass::nameless || c.kind == CaseClass::left_out;
  if (c.kind == CaseClass::single && c.size_in_limits >= well_above) {
    out.shares["single at 3 limits, right"].add(c.right);
    out.shares["single at 3 limits, right within sets"].add(c.right_within_set);
    out.shares["single at 3 limits, not called none"].add(c.exit_status == 0 &&
                                                          c.verdict != "none");
  }
  if (c.kind == CaseClass::single) out.shares["single of all sizes, right"].add(c.right);
  if (in_catalogue) out.shares["top three"].add(c.in_top_three);
  if (c.kind == CaseClass::pair || c.kind == CaseClass::triple)
    out.shares[to_string(c.kind) + ", exact"].add(c.right);
  if (c.kind == CaseClass::none || c.kind == CaseClass::calibration_only)
    out.shares[to_string(c.kind) + ", false alarm"].add(without_calibrations(c.verdict) != "none");
  if (outside) {
    out.shares[to_string(c.kind) + ", outside_catalogue"].add(c.right);
    out.shares[to_string(c.kind) + ", wrong name above 0.8"].add(!c.right && c.verdict != "none" &&
                                                                 c.probability > sure);
  }
  if (c.kind == CaseClass::below_limit)
    out.shares["below the limit, wrong name above 0.8"].add(c.verdict != "none" && !c.right &&
                                                            c.probability > sure);
  if (c.kind == CaseClass::wrong_metadata) out.shares["wrong metadata, noticed"].add(c.right);
  if (in_catalogue) {
    out.shares["wrong name above 0.8"].add(!c.right && c.verdict != "none" && c.probability > sure);
  }
  if (in_catalogue || outside) out.shares["95 % set holds the truth"].add(c.in_confidence_set);
  if (named) out.shares["links right"].add(c.links_right);
  if (in_catalogue && c.resolved_as_recommended)
    out.shares["undecided, the recommended experiment resolves"].add(*c.resolved_as_recommended);
  if (in_catalogue && c.resolved_by_chance)
    out.shares["undecided, another one resolves"].add(*c.resolved_by_chance);
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

void measure(TrialScore& out) {
  std::vector<double> closed, transfer, errors, seconds, known, outside, set_sizes;
  std::vector<std::pair<double, bool>> answers;
  for (const ScoredCase& c : out.cases) {
    if (c.gap_closed) closed.push_back(*c.gap_closed);
    if (c.transfer_gap_closed) transfer.push_back(*c.transfer_gap_closed);
    errors.insert(errors.end(), c.parameter_errors.begin(), c.parameter_errors.end());
    if (c.exit_status != 0 || c.kind == CaseClass::wrong_metadata) continue;
    seconds.push_back(c.seconds);
    set_sizes.push_back(static_cast<double>(c.confidence_set_size));
    const bool is_outside = c.kind == CaseClass::nameless || c.kind == CaseClass::left_out;
    if (!counts_for_odds(c)) continue;
    (is_outside ? outside : known).push_back(c.probability_of_outside);
    answers.emplace_back(c.probability, c.right);
  }
  out.reliability = reliability(answers);
  learn_trust(out);
  const double n = static_cast<double>(set_sizes.size());
  out.figures = {
      {"gap closed, median", quantile(closed, 0.5)},
      {"gap closed, 5th percentile", quantile(closed, 0.05)},
      {"gap closed at another level and wind, median", quantile(transfer, 0.5)},
      {"parameter error over its deviation, median", quantile(errors, 0.5)},
      {"seconds a case, median", quantile(seconds, 0.5)},
      {"outside_catalogue, area under the curve", auroc(known, outside)},
      {"expected calibration error", expected_calibration_error(out.reliability)},
      {"95 % set, mean size", std::accumulate(set_sizes.begin(), set_sizes.end(), 0.) / n}};
}

}  // namespace

TrialScore score_trial(const TrialIndex& trial, const json& labels) {
  TrialScore out;
  for (const TrialEntry& entry : trial.cases) {
    const fs::path file = trial.answer_file(entry);
    if (!fs::exists(file)) {
      ++out.unanswered;
      continue;
    }
    out.cases.push_back(scored(entry.name, labels.at(entry.name), signals::read_json(file)));
    count(out, out.cases.back());
  }
  measure(out);
  return out;
}

json to_json(const TrialScore& score) {
  json shares = json::object(), figures = json::object(), bins = json::array();
  for (const auto& [name, share] : score.shares)
    shares[name] = {{"hits", share.hits}, {"of", share.of}, {"ci95", share.ci95()}};
  for (const auto& [name, value] : score.figures)
    figures[name] = std::isfinite(value) ? json(value) : json(nullptr);
  for (const ReliabilityBin& bin : score.reliability)
    bins.push_back({{"low", bin.low},
                    {"high", bin.high},
                    {"said", bin.said},
                    {"right", bin.right.value()},
                    {"n", bin.right.of}});
  json trust = json::object();
  for (const auto& [kind, learnt] : score.trust)
    trust[kind] = {
        {"offset", learnt.first.offset}, {"slope", learnt.first.slope}, {"n", learnt.second}};
  json unknown = json::object();
  for (const auto& [kind, share] : score.unknown)
    unknown[kind] = {{"share", share.value()}, {"of", share.of}};
  return {{"schema", "vibrissa-trial-score-1"},
          {"unanswered", score.unanswered},
          {"shares", shares},
          {"figures", figures},
          {"reliability", bins},
          {"trust", trust},
          {"unknown", unknown}};
}

report::Table case_table(const TrialScore& score) {
  report::Table table({{"case", ""},
                       {"class", ""},
                       {"size", "detection limits", 3},
                       {"effects", ""},
                       {"truth", ""},
                       {"verdict", ""},
                       {"probability", "", 3},
                       {"right", ""},
                       {"gap closed", "", 3},
                       {"time", "s", 3}});
  for (const ScoredCase& c : score.cases)
    table.add_row({c.name, to_string(c.kind),
                   c.size_in_limits > 0. ? std::optional(c.size_in_limits) : std::nullopt,
                   c.effects, c.truth, c.verdict, c.probability, c.right ? "yes" : "no",
                   c.gap_closed, c.seconds});
  return table;
}

report::Table summary_table(const TrialScore& score) {
  report::Table table(
      {{"what", ""}, {"value", "", 3}, {"low", "", 3}, {"high", "", 3}, {"of", ""}});
  for (const auto& [name, share] : score.shares) {
    const auto [low, high] = share.ci95();
    table.add_row({name, share.value(), low, high, share.of});
  }
  for (const auto& [name, value] : score.figures) table.add_row({name, value, {}, {}, {}});
  return table;
}

report::Table confusion_table(const TrialScore& score) {
  struct Cell {
    std::size_t n = 0;
    double expected = 0.;
  };
  std::map<std::pair<std::string, std::string>, Cell> cells;  // truth, verdict
  for (const ScoredCase& c : score.cases) {
    if (!c.right) ++cells[{c.truth, c.verdict}].n;
    for (const auto& [name, probability] : c.probabilities)
      if (name != c.verdict) cells[{name, c.verdict}].expected += probability;
  }
  constexpr double worth_telling = 0.5;
  report::Table table({{"truth", ""}, {"verdict", ""}, {"cases", ""}, {"expected", ""}});
  for (const auto& [pair, cell] : cells)
    if (cell.n > 0 || cell.expected >= worth_telling)
      table.add_row({pair.first, pair.second, cell.n, cell.expected});
  return table;
}

std::vector<report::Figure> trial_figures(const TrialScore& score) {
  report::Panel sizes{.title = "Single effects",
                      .x_label = "Effect size [multiples of the detection limit]",
                      .y_label = "Share of correct answers [1]",
                      .log_x = true,
                      .y_range = report::Range{0., 1.}};
  report::Curve accuracy{.label = "correct", .x = {}, .y = {}},
      band{.label = "95 % interval", .style = report::CurveStyle::band};
  for (const auto& [low, high] : {std::pair{1., 2.}, {2., 4.}, {4., 8.}, {8., 16.}, {16., 31.}}) {
    Share share;
    for (const ScoredCase& c : score.cases)
      if (c.kind == CaseClass::single && c.size_in_limits >= low && c.size_in_limits < high)
        share.add(c.right);
    if (share.of == 0) continue;
    const double middle = std::sqrt(low * high);
    accuracy.x.push_back(middle);
    accuracy.y.push_back(share.value());
    band.x.push_back(middle);
    band.y_low.push_back(share.ci95()[0]);
    band.y_high.push_back(share.ci95()[1]);
  }
  sizes.curves = {band, accuracy};
  report::Panel said{.title = "Probabilities",
                     .x_label = "Stated probability [1]",
                     .y_label = "Share of correct answers [1]",
                     .x_range = report::Range{0., 1.},
                     .y_range = report::Range{0., 1.}};
  report::Curve right{.label = "answers", .x = {}, .y = {}},
      scatter{.label = "95 % interval", .style = report::CurveStyle::band};
  for (const ReliabilityBin& bin : score.reliability) {
    right.x.push_back(bin.said);
    right.y.push_back(bin.right.value());
    scatter.x.push_back(bin.said);
    scatter.y_low.push_back(bin.right.ci95()[0]);
    scatter.y_high.push_back(bin.right.ci95()[1]);
  }
  said.curves = {scatter,
                 right,
                 {.label = "perfect calibration",
                  .style = report::CurveStyle::dashed,
                  .x = {0., 1.},
                  .y = {0., 1.}}};
  return {
      {.name = "accuracy",
       .title = "Accuracy against effect size",
       .caption = "The 95 % intervals are exact binomial intervals.",
       .panels = {sizes}},
      {.name = "reliability",
       .title = "Reliability diagram",
       .caption = "Below the dashed line the stated probabilities are too high (overconfident).",
       .panels = {said}}};
}

}  // namespace vibrissa::trial
