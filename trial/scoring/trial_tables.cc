#include "trial/scoring/trial_tables.h"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

namespace vibrissa::trial {
namespace {

using nlohmann::json;

json shares_of(const std::map<std::string, Share>& shares) {
  json out = json::object();
  for (const auto& [name, share] : shares)
    out[name] = {{"hits", share.hits}, {"of", share.of}, {"ci95", share.ci95()}};
  return out;
}

json figures_of(const std::map<std::string, double>& figures) {
  json out = json::object();
  for (const auto& [name, value] : figures)
    out[name] = std::isfinite(value) ? json(value) : json(nullptr);
  return out;
}

}  // namespace

json to_json(const TrialScore& score) {
  json bins = json::array();
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
  json classes = json::object();
  for (const auto& [name, scores] : score.classes)
    classes[name] = {{"shares", shares_of(scores.shares)}, {"figures", figures_of(scores.figures)}};
  return {{"schema", "vibrissa-trial-score-1"},
          {"unanswered", score.unanswered},
          {"shares", shares_of(score.shares)},
          {"figures", figures_of(score.figures)},
          {"classes", classes},
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
                       {"time", "s", 3},
                       {"set", ""},
                       {"distance", ""},
                       {"form error", ""},
                       {"hold", ""},
                       {"way in", ""}});
  for (const ScoredCase& c : score.cases) {
    const Circumstances circumstances = c.circumstances.value_or(Circumstances{});
    table.add_row({c.name, to_string(c.kind),
                   c.size_in_limits > 0. ? std::optional(c.size_in_limits) : std::nullopt,
                   c.effects, c.truth, c.verdict, c.probability, c.right ? "yes" : "no",
                   c.gap_closed, c.seconds, to_string(circumstances.set),
                   to_string(circumstances.distance), to_string(circumstances.form_error), c.hold,
                   to_string(circumstances.way_in)});
  }
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

report::Table class_table(const TrialScore& score) {
  report::Table table(
      {{"what", ""}, {"class", ""}, {"value", "", 3}, {"low", "", 3}, {"high", "", 3}, {"of", ""}});
  const auto add = [&](const std::string& what, const std::string& name, const Share& share) {
    const auto [low, high] = share.ci95();
    table.add_row({what, name, share.value(), low, high, share.of});
  };
  for (const auto& [what, total] : score.shares) {
    add(what, "all", total);
    for (const auto& [name, scores] : score.classes)
      if (const auto found = scores.shares.find(what); found != scores.shares.end())
        add(what, name, found->second);
  }
  for (const auto& [what, total] : score.figures) {
    table.add_row({what, "all", total, {}, {}, {}});
    for (const auto& [name, scores] : score.classes)
      if (const double value = scores.figures.at(what); std::isfinite(value))
        table.add_row({what, name, value, {}, {}, {}});
  }
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
